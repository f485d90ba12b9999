#include "core/environment.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

struct Named {
    EnvLayout layout;
    const char* name;
};
constexpr std::array<Named, 4> kNames{{{EnvLayout::LatLong, "latlong"},
                                       {EnvLayout::Cube, "cube"},
                                       {EnvLayout::DualParaboloid, "dual_paraboloid"},
                                       {EnvLayout::Octahedral, "octahedral"}}};

/// A cube face: direction = major + a·right + b·down, a and b in [−1, 1].
struct CubeFace {
    Vec3 major, right, down;
};
const std::array<CubeFace, 6> kFaces{{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                      {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                      {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
                                      {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}}};

int faceOf(const Vec3& d) {
    const Vec3 a = glm::abs(d);
    if (a.x >= a.y && a.x >= a.z) return d.x >= 0 ? 0 : 1;
    if (a.y >= a.z) return d.y >= 0 ? 2 : 3;
    return d.z >= 0 ? 4 : 5;
}

/// Seam-centred coordinate c in [−1, 1] and its texel position.
double seamCoordinate(double position, int size) { return size == 1 ? 0 : 2 * (position - 0.5) / (size - 1) - 1; }
double seamPosition(double c, int size) { return (c + 1) / 2 * (size - 1) + 0.5; }

double nonNegativeSign(double v) { return v < 0 ? -1.0 : 1.0; }

Vec3 octahedralDirection(double s, double t) {
    Vec3 d(s, t, 1 - std::abs(s) - std::abs(t));
    if (d.z < 0) {
        d.x = (1 - std::abs(t)) * nonNegativeSign(s);
        d.y = (1 - std::abs(s)) * nonNegativeSign(t);
    }
    return glm::normalize(d);
}

/// Solid angle of a triangle seen from the origin (van Oosterom & Strackee 1983).
double triangleSolidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
    return 2 * std::atan2(numerator, la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la);
}

/// The part of a polygon with side(x + y − 1) ≤ 0; the result of folding it when `outer`, lifted to the octahedron.
double octantPart(const std::array<glm::dvec2, 4>& rectangle, bool outer) {
    const double side = outer ? -1 : 1;
    const auto distance = [&](const glm::dvec2& p) { return side * (p.x + p.y - 1); };
    std::vector<Vec3> polygon;
    const auto add = [&](const glm::dvec2& p) {
        const glm::dvec2 q = outer ? glm::dvec2(1 - p.y, 1 - p.x) : p;
        polygon.emplace_back(q.x, q.y, 1 - q.x - q.y);
    };
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 &p = rectangle[i], &q = rectangle[(i + 1) % 4];
        const double dp = distance(p), dq = distance(q);
        if (dp <= 0) add(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) add(p + (q - p) * (dp / (dp - dq)));
    }
    double sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) sum += triangleSolidAngle(polygon[0], polygon[i - 1], polygon[i]);
    return sum;
}

/// [lo, hi] cut to [−1, 1] and split at 0, as absolute values.
std::vector<glm::dvec2> halves(double lo, double hi) {
    lo = std::max(lo, -1.0);
    hi = std::min(hi, 1.0);
    std::vector<glm::dvec2> out;
    if (lo < 0) out.emplace_back(std::max(0.0, -hi), -lo);
    if (hi > 0) out.emplace_back(std::max(0.0, lo), hi);
    return out;
}

double octahedralSolidAngle(int size, int x, int y) {
    if (size == 1) return 4 * kPi;
    double sum = 0;
    for (const glm::dvec2& s : halves(seamCoordinate(x, size), seamCoordinate(x + 1, size)))
        for (const glm::dvec2& t : halves(seamCoordinate(y, size), seamCoordinate(y + 1, size))) {
            const std::array<glm::dvec2, 4> r{{{s.x, t.x}, {s.y, t.x}, {s.y, t.y}, {s.x, t.y}}};
            sum += octantPart(r, false) + octantPart(r, true);
        }
    return sum;
}

/// ∫ 4/(1 + s² + t²)² dt from 0.
double paraboloidColumn(double s, double t) {
    const double a2 = 1 + s * s, a = std::sqrt(a2);
    return 2 * t / (a2 * (a2 + t * t)) + 2 * std::atan(t / a) / (a2 * a);
}

constexpr int kGauss = 8;  // Gauss–Legendre on [0, 1]
constexpr std::array<double, kGauss> kGaussNode{0.01985507175123188, 0.10166676129318664, 0.2372337950418355,
                                                0.4082826787521751,  0.5917173212478249,  0.7627662049581645,
                                                0.8983332387068134,  0.9801449282487681};
constexpr std::array<double, kGauss> kGaussWeight{0.05061426814518813, 0.11119051722668724, 0.15685332293894363,
                                                  0.1813418916891810,  0.1813418916891810,  0.15685332293894363,
                                                  0.11119051722668724, 0.05061426814518813};

/// ∫∫ 4/(1 + r²)² ds dt over the cell's part inside the unit disk; s = sin ψ, so that the rim's ends stay smooth.
double paraboloidSolidAngle(int size, int x, int y) {
    if (size == 1) return 2 * kPi;
    const double s0 = std::max(-1.0, seamCoordinate(x, size)), s1 = std::min(1.0, seamCoordinate(x + 1, size));
    const double t0 = std::max(-1.0, seamCoordinate(y, size)), t1 = std::min(1.0, seamCoordinate(y + 1, size));
    std::vector<double> cuts{std::asin(s0), std::asin(s1)};
    for (const double t : {t0, t1})
        for (const double sign : {-1.0, 1.0}) {
            const double psi = sign * std::acos(std::min(1.0, std::abs(t)));
            if (psi > cuts[0] && psi < std::asin(s1)) cuts.push_back(psi);
        }
    std::sort(cuts.begin(), cuts.end());
    double sum = 0;
    for (std::size_t i = 1; i < cuts.size(); ++i)
        for (int k = 0; k < kGauss; ++k) {
            const double psi = cuts[i - 1] + (cuts[i] - cuts[i - 1]) * kGaussNode[k], rim = std::cos(psi);
            const double low = std::clamp(t0, -rim, rim), high = std::clamp(t1, -rim, rim), s = std::sin(psi);
            sum += kGaussWeight[k] * (cuts[i] - cuts[i - 1]) * rim *
                   (paraboloidColumn(s, high) - paraboloidColumn(s, low));
        }
    return sum;
}

/// Solid angle of the cube face's corner rectangle from (0, 0) to (a, b).
double cubeCorner(double a, double b) { return std::atan2(a * b, std::sqrt(1 + a * a + b * b)); }

double cubeSolidAngle(int size, int x, int y) {
    const double a0 = 2.0 * x / size - 1, a1 = 2.0 * (x + 1) / size - 1;
    const double b0 = 2.0 * (y % size) / size - 1, b1 = 2.0 * (y % size + 1) / size - 1;
    return cubeCorner(a1, b1) - cubeCorner(a0, b1) - cubeCorner(a1, b0) + cubeCorner(a0, b0);
}

Rgb blend(const Rgb& c00, const Rgb& c10, const Rgb& c01, const Rgb& c11, double a, double b) {
    return (1 - b) * ((1 - a) * c00 + a * c10) + b * ((1 - a) * c01 + a * c11);
}

/// Texel (i, j) of a face, or its neighbour across the edge when one index is −1 or N.
Rgb cubeTexel(const EnvMap& map, int size, int face, int i, int j) {
    const bool outX = i < 0 || i >= size, outY = j < 0 || j >= size;
    if (!outX && !outY) return map.image.rgb(i, face * size + j);
    const CubeFace& f = kFaces[face];
    const auto coordinate = [&](int k) { return std::clamp((2 * k + 1.0) / size - 1, -1.0, 1.0); };
    const Vec3 d = f.major * (1 - 1.0 / size) + f.right * coordinate(i) + f.down * coordinate(j);
    const glm::dvec2 p = envPosition(EnvLayout::Cube, size, d);
    return map.image.rgb(std::clamp(static_cast<int>(p.x), 0, size - 1),
                         std::clamp(static_cast<int>(p.y), 0, 6 * size - 1));
}

Rgb sampleCube(const EnvMap& map, const Vec3& direction) {
    const int size = map.size(), face = faceOf(direction);
    const glm::dvec2 p = envPosition(EnvLayout::Cube, size, direction) - glm::dvec2(0.5, 0.5 + face * size);
    const int i = static_cast<int>(std::floor(p.x)), j = static_cast<int>(std::floor(p.y));
    std::array<Rgb, 4> c;
    int corner = -1;
    for (int k = 0; k < 4; ++k) {
        const int x = i + k % 2, y = j + k / 2;
        if ((x < 0 || x >= size) && (y < 0 || y >= size))
            corner = k;
        else
            c[k] = cubeTexel(map, size, face, x, y);
    }
    if (corner >= 0) c[corner] = (c[corner ^ 1] + c[corner ^ 2] + c[corner ^ 3]) / 3.0;
    return blend(c[0], c[1], c[2], c[3], p.x - i, p.y - j);
}

/// Bilinear within the rows [top, top + rows): repeated in x or clamped.
Rgb samplePlane(const Image& image, const glm::dvec2& position, int top, int rows, bool repeatX) {
    const double x = position.x - 0.5, y = std::clamp(position.y - 0.5, 0.0, rows - 1.0);
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(y), width = image.width();
    const auto column = [&](int k) { return repeatX ? (k + width) % width : std::clamp(k, 0, width - 1); };
    const int below = std::min(j + 1, rows - 1);
    return blend(image.rgb(column(i), top + j), image.rgb(column(i + 1), top + j), image.rgb(column(i), top + below),
                 image.rgb(column(i + 1), top + below), x - i, y - j);
}

}  // namespace

std::string toString(EnvLayout layout) {
    for (const Named& n : kNames)
        if (n.layout == layout) return n.name;
    return "?";
}

EnvLayout envLayoutFromString(const std::string& name) {
    std::string known;
    for (const Named& n : kNames) {
        if (name == n.name) return n.layout;
        known += (known.empty() ? "" : ", ") + std::string(n.name);
    }
    throw std::invalid_argument(fmt::format("unknown layout '{}'; known: {}", name, known));
}

glm::ivec2 envExtent(EnvLayout layout, int size) {
    switch (layout) {
        case EnvLayout::LatLong:
            return {2 * size, size};
        case EnvLayout::Cube:
            return {size, 6 * size};
        case EnvLayout::DualParaboloid:
            return {size, 2 * size};
        case EnvLayout::Octahedral:
            break;
    }
    return {size, size};
}

EnvMap::EnvMap(EnvLayout mapLayout, int size) : layout(mapLayout) {
    require(size >= 1, "EnvMap: size must be >= 1");
    const glm::ivec2 extent = envExtent(layout, size);
    image = Image(extent.x, extent.y, 3);
}

EnvMap::EnvMap(EnvLayout mapLayout, Image radiance) : layout(mapLayout), image(std::move(radiance)) {
    const glm::ivec2 extent = envExtent(layout, size());
    require(image.channels() == 3, "EnvMap: expected three channels");
    require(
        size() >= 1 && image.width() == extent.x && image.height() == extent.y,
        fmt::format("EnvMap: {} x {} has not the proportions of {}", image.width(), image.height(), toString(layout)));
}

int EnvMap::size() const { return layout == EnvLayout::LatLong ? image.height() : image.width(); }

Vec3 envDirection(EnvLayout layout, int size, double x, double y) {
    switch (layout) {
        case EnvLayout::LatLong: {
            const double latitude = kPi * (0.5 - y / size), longitude = kPi * (1 - x / size);
            return {std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                    std::cos(longitude) * std::cos(latitude)};
        }
        case EnvLayout::Cube: {
            const int face = std::clamp(static_cast<int>(y / size), 0, 5);
            const CubeFace& f = kFaces[face];
            return glm::normalize(f.major + f.right * (2 * x / size - 1) + f.down * (2 * (y - face * size) / size - 1));
        }
        case EnvLayout::DualParaboloid: {
            const bool back = y >= size;
            const double s = seamCoordinate(x, size), t = -seamCoordinate(back ? y - size : y, size),
                         r2 = s * s + t * t;
            return Vec3(2 * s, 2 * t, back ? r2 - 1 : 1 - r2) / (1 + r2);
        }
        case EnvLayout::Octahedral:
            break;
    }
    return octahedralDirection(seamCoordinate(x, size), -seamCoordinate(y, size));
}

glm::dvec2 envPosition(EnvLayout layout, int size, const Vec3& direction) {
    const Vec3& d = direction;
    switch (layout) {
        case EnvLayout::LatLong: {
            const double latitude = std::atan2(d.y, std::hypot(d.x, d.z)), longitude = std::atan2(d.x, d.z);
            return {(1 - longitude / kPi) * size, (0.5 - latitude / kPi) * size};
        }
        case EnvLayout::Cube: {
            const int face = faceOf(d);
            const CubeFace& f = kFaces[face];
            const double m = glm::dot(d, f.major);
            // A direction on an edge belongs to its face's last texel, not to the next face's first.
            const auto place = [&](double c) { return std::min((c / m + 1) / 2, 1 - 1e-12) * size; };
            return {place(glm::dot(d, f.right)), place(glm::dot(d, f.down)) + face * size};
        }
        case EnvLayout::DualParaboloid: {
            const double scale = 1 / (glm::length(d) + std::abs(d.z));
            return {seamPosition(d.x * scale, size), seamPosition(-d.y * scale, size) + (d.z < 0 ? size : 0)};
        }
        case EnvLayout::Octahedral:
            break;
    }
    const double scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    double s = d.x * scale, t = d.y * scale;
    if (d.z < 0) {
        const double folded = (1 - std::abs(t)) * nonNegativeSign(s);
        t = (1 - std::abs(s)) * nonNegativeSign(t);
        s = folded;
    }
    return {seamPosition(s, size), seamPosition(-t, size)};
}

double envSolidAngle(EnvLayout layout, int size, int x, int y) {
    switch (layout) {
        case EnvLayout::LatLong:
            return kPi / size *
                   (std::sin(kPi * (0.5 - static_cast<double>(y) / size)) - std::sin(kPi * (0.5 - (y + 1.0) / size)));
        case EnvLayout::Cube:
            return cubeSolidAngle(size, x, y);
        case EnvLayout::DualParaboloid:
            return paraboloidSolidAngle(size, x, y % size);
        case EnvLayout::Octahedral:
            break;
    }
    return octahedralSolidAngle(size, x, y);
}

/// One face's solid angles from those of its corner rectangles; all six are alike.
static std::vector<double> cubeSolidAngles(int size) {
    const std::size_t edge = size;
    std::vector<double> corner((edge + 1) * (edge + 1)), out(6 * edge * edge);
    for (std::size_t j = 0; j <= edge; ++j)
        for (std::size_t i = 0; i <= edge; ++i)
            corner[j * (edge + 1) + i] =
                cubeCorner(2.0 * static_cast<double>(i) / size - 1, 2.0 * static_cast<double>(j) / size - 1);
    for (std::size_t j = 0; j < edge; ++j)
        for (std::size_t i = 0; i < edge; ++i) {
            const double* c = &corner[j * (edge + 1) + i];
            out[j * edge + i] = c[edge + 2] - c[edge + 1] - c[1] + c[0];
        }
    for (std::size_t k = edge * edge; k < out.size(); ++k) out[k] = out[k - edge * edge];
    return out;
}

std::vector<double> envSolidAngles(EnvLayout layout, int size, unsigned threads) {
    require(size >= 1, "envSolidAngles: size must be >= 1");
    if (layout == EnvLayout::Cube) return cubeSolidAngles(size);
    const glm::ivec2 extent = envExtent(layout, size);
    std::vector<double> out(static_cast<std::size_t>(extent.x) * extent.y);
    parallelFor(extent.y, threads, [&](std::size_t y) {
        for (int x = 0; x < extent.x; ++x) out[y * extent.x + x] = envSolidAngle(layout, size, x, static_cast<int>(y));
    });
    return out;
}

Rgb sampleEnv(const EnvMap& map, const Vec3& direction) {
    const int size = map.size();
    if (map.layout == EnvLayout::Cube) return sampleCube(map, direction);
    glm::dvec2 position = envPosition(map.layout, size, direction);
    if (map.layout != EnvLayout::DualParaboloid)
        return samplePlane(map.image, position, 0, map.image.height(), map.layout == EnvLayout::LatLong);
    const int top = direction.z < 0 ? size : 0;
    position.y -= top;
    return samplePlane(map.image, position, top, size, false);
}

}  // namespace nacre
