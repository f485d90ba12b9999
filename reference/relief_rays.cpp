#include "reference/relief_rays.hpp"

#include <limits>

#include "core/error.hpp"

namespace nacre {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGrazing = 1e-12;   // of a slope: a light parallel to a ramp is lit whatever its rounding
constexpr double kRounding = 1e-11;  // of heights and slopes: positions on a line of 1e4 texels are good to 1e-12
constexpr double kBorder = 1e-9;     // texels: a point so near to a border is on it, or rise / distance is all rounding
constexpr double kCorner = 1e-12;    // of a distance: crossings of a row and of a column that near are one corner
constexpr double kAxis = 1e-15;  // a component of a direction that is an axis but for rounding, as cos(π/2) = 6e-17

/// Bilinear: a = (0, 0), b = (1, 0), c = (0, 1), d = (1, 1). NaN anywhere: no patch.
struct Patch {
    double a, b, c, d;

    bool exists() const { return !std::isnan(a + b + c + d); }
    double highest() const { return std::max(std::max(a, b), std::max(c, d)); }
    double magnitude() const {
        return std::max(std::max(std::abs(a), std::abs(b)), std::max(std::abs(c), std::abs(d)));
    }
    double twist() const { return (a - b) - (c - d); }
    double height(const Vec2& at) const { return a + at.x * (b - a) + at.y * (c - a) + at.x * at.y * twist(); }
    Vec2 gradient(const Vec2& at) const { return {b - a + at.y * twist(), c - a + at.x * twist()}; }
    Vec3 normal(const Vec2& at) const {
        const Vec2 g = gradient(at);
        return glm::normalize(Vec3(-g.x, -g.y, 1));
    }
    /// The same surface one patch further, from x = 1…2 or y = 1…2.
    Patch continuedInX() const { return {b, 2 * b - a, d, 2 * d - c}; }
    Patch continuedInY() const { return {c, d, 2 * c - a, 2 * d - b}; }
};

Patch patchOf(const Relief& relief, int column, int row) {
    const std::size_t width = static_cast<std::size_t>(relief.columns.patches) + 1;
    const float* p = relief.corners.data() + static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
    return {p[0], p[1], p[width], p[width + 1]};
}

/// The patches that a line crosses, along one axis.
class AxisWalk {
public:
    /// \param start  from texel centre 0;  \param d  distance along the axis for each unit of the line's parameter
    AxisWalk(const ReliefAxis& axis, double start, double d)
        : axis_(axis), start_(start), d_(d), inverse_(d == 0 ? 0 : 1 / d), step_(d < 0 ? -1 : 1) {
        const double whole = std::floor(start);
        patch_ = static_cast<std::int64_t>(whole) - (d < 0 && whole == start ? 1 : 0);
        stored_ = axis.stored(patch_);
        alongBorder_ = d == 0 && whole == start;
        setExit();
    }
    void advance() {
        patch_ += step_;
        stored_ += step_;
        if (axis_.wrap == Wrap::Clamp)
            stored_ = axis_.stored(patch_);
        else if (stored_ == axis_.patches)
            stored_ = 0;
        else if (stored_ < 0)
            stored_ = axis_.patches - 1;
        setExit();
    }
    int stored() const { return stored_; }
    /// For a line between two patches: the one on the lower side.
    bool alongBorder() const { return alongBorder_; }
    int lower() const { return axis_.stored(patch_ - 1); }
    double exit() const { return exit_; }
    /// Position in the patch, 0…1.
    double at(double t) const { return clamp01(start_ + t * d_ - static_cast<double>(patch_)); }

private:
    void setExit() {
        exit_ = d_ == 0 ? kInfinity : (static_cast<double>(patch_ + (d_ > 0 ? 1 : 0)) - start_) * inverse_;
    }
    const ReliefAxis& axis_;
    double start_, d_, inverse_, exit_ = 0;
    std::int64_t patch_ = 0;
    int stored_ = 0, step_;
    bool alongBorder_ = false;
};

/// The patch entered; on a line along a border, where there is none, the one that ends at the border.
Patch patchAt(const Relief& relief, const AxisWalk& x, const AxisWalk& y) {
    Patch patch = patchOf(relief, x.stored(), y.stored());
    if (!patch.exists() && x.alongBorder()) patch = patchOf(relief, x.lower(), y.stored()).continuedInX();
    if (!patch.exists() && y.alongBorder()) patch = patchOf(relief, x.stored(), y.lower()).continuedInY();
    if (!patch.exists() && x.alongBorder() && y.alongBorder())
        patch = patchOf(relief, x.lower(), y.lower()).continuedInX().continuedInY();
    return patch;
}

/// Calls visit(patch, position in it at t0, t0, t1) for the patches (holes too) that the line from + t·d crosses, up to
/// t = end, until visit returns false.
template <typename Visit>
void walk(const Relief& relief, const Vec2& from, const Vec2& d, double end, const Visit& visit) {
    AxisWalk x(relief.columns, from.x - 0.5, d.x), y(relief.rows, from.y - 0.5, d.y);
    for (double t = 0; t < end;) {
        const double next = std::min(std::min(x.exit(), y.exit()), end);
        if (!visit(patchAt(relief, x, y), Vec2(x.at(t), y.at(t)), t, next)) return;
        const double corner = next * (1 + kCorner);
        if (x.exit() <= corner) x.advance();
        if (y.exit() <= corner) y.advance();  // both: the patches beside the corner are not crossed
        t = next;
    }
}

/// max over u in [0, length] of (rise + slope·u + curve·u²) / (t0 + u): the chord from the line's start, t0 before.
double steepestChord(double rise, double slope, double curve, double t0, double length) {
    const auto chord = [&](double u) { return (rise + u * (slope + u * curve)) / (t0 + u); };
    double best = std::max(t0 == 0 ? slope : rise / t0, chord(length));
    // In t = t0 + u the chord is A/t + B + curve·t: it has a maximum where t² = A/curve, both negative.
    const double A = rise - t0 * (slope - t0 * curve);
    if (A < 0 && curve < 0) {
        const double u = std::sqrt(A / curve) - t0;
        if (u > 0 && u < length) best = std::max(best, chord(u));
    }
    return best;
}

/// The steepest chord from the surface at `from` towards d (unit), if above `least` ≥ 0; else `least`. May return
/// early with any chord above `enough`.
double steepest(const Relief& relief, const Vec2& from, const Vec2& d, double least, double enough) {
    const double own = relief.heightAt(from);
    if (std::isnan(own)) return least;
    double best = least;
    walk(relief, from, d, relief.reach, [&](const Patch& patch, const Vec2& at, double t0, double t1) {
        if (relief.high - own <= best * t0) return false;
        if (!patch.exists() || patch.highest() - own <= best * t0) return true;
        const bool touches = t0 < kBorder;
        const double slope = glm::dot(patch.gradient(at), d), curve = patch.twist() * d.x * d.y;
        best = std::max(best,
                        steepestChord(touches ? 0 : patch.height(at) - own, slope, curve, touches ? 0 : t0, t1 - t0));
        return best <= enough;
    });
    return best;
}

/// Where the ray z + u·d goes below the patch, u in [0, length); negative where it doesn't. With f = ray − surface =
/// f0 + f1·u + f2·u², the first root at which f falls.
double descent(const Patch& patch, const Vec2& at, double z, const Vec3& d, double length) {
    constexpr double kNone = -1;
    const double scale = std::abs(z) + patch.magnitude();
    const Vec2 slopes = patch.gradient(at) * Vec2(d.x, d.y);
    const auto rounded = [](double value, double size) { return std::abs(value) <= kRounding * size ? 0 : value; };
    const double f0 = rounded(z - patch.height(at), scale);
    const double f1 = rounded(d.z - slopes.x - slopes.y, std::abs(d.z) + std::abs(slopes.x) + std::abs(slopes.y));
    const double f2 = -rounded(patch.twist(), patch.magnitude()) * d.x * d.y;
    if (f0 < 0) return 0;
    if (f0 == 0 && f1 == 0 && f2 < 0) return 0;  // from a saddle's level line
    const double discriminant = f1 * f1 - 4 * f2 * f0;
    if ((f1 >= 0 && f2 >= 0) || discriminant <= 0) return kNone;  // rises for ever, or touches at most
    const double root = f1 < 0 ? 2 * f0 / (std::sqrt(discriminant) - f1) : (f1 + std::sqrt(discriminant)) / (-2 * f2);
    return root < length - kRounding ? root : kNone;  // at its very end the next patch decides whether it goes below
}

double snapped(double component) { return std::abs(component) < kAxis ? 0 : component; }

}  // namespace

ReliefAxis::ReliefAxis(int texelCount, Wrap axisWrap) : texels(texelCount), wrap(axisWrap) {
    patches = wrap == Wrap::Clamp ? texels + 1 : wrap == Wrap::Mirror ? 2 * texels : texels;
}

int ReliefAxis::stored(std::int64_t patch) const {
    if (wrap == Wrap::Clamp) return static_cast<int>(std::clamp<std::int64_t>(patch, -1, texels - 1)) + 1;
    return static_cast<int>((patch % patches + patches) % patches);
}

Relief::Relief(const HeightMap& map)
    : columns(map.width(), map.wrap), rows(map.height(), map.wrap), high(heightRange(map).high), reach(reachOf(map)) {
    validateHeightMap(map);
    const int first = map.wrap == Wrap::Clamp ? -1 : 0;
    corners.reserve(static_cast<std::size_t>(columns.patches + 1) * static_cast<std::size_t>(rows.patches + 1));
    for (int j = 0; j <= rows.patches; ++j)
        for (int i = 0; i <= columns.patches; ++i) corners.push_back(map.at(i + first, j + first));
}

double Relief::heightAt(const Vec2& p) const {
    const double x = std::floor(p.x - 0.5), y = std::floor(p.y - 0.5), s = p.x - 0.5 - x, t = p.y - 0.5 - y;
    Patch q = patchOf(*this, columns.stored(static_cast<std::int64_t>(x)), rows.stored(static_cast<std::int64_t>(y)));
    if (s == 0) q.b = q.a, q.d = q.c;  // on a border a hole on the other side is no matter
    if (t == 0) q.c = q.a, q.d = q.b;
    return q.height({s, t});
}

double horizonSlope(const Relief& relief, const Vec2& from, double azimuth) {
    require(std::isfinite(from.x) && std::isfinite(from.y) && std::isfinite(azimuth), "horizonSlope: not finite");
    return steepest(relief, from, {snapped(std::cos(azimuth)), snapped(std::sin(azimuth))}, 0, kInfinity);
}

bool isLit(const Relief& relief, const Vec2& from, const Vec3& light) {
    require(std::isfinite(from.x) && std::isfinite(from.y) && isFinite(light), "isLit: not finite");
    const Vec2 plane(snapped(light.x), snapped(light.y));
    const double r = glm::length(plane);
    if (light.z < 0) return false;
    if (r == 0) return true;
    const double slope = light.z / r * (1 + kGrazing);
    return steepest(relief, from, plane / r, slope, slope) <= slope;
}

std::optional<ReliefHit> firstHit(const Relief& relief, const Vec3& from, const Vec3& direction) {
    require(isFinite(from) && std::abs(glm::length(direction) - 1) < 1e-6, "firstHit: expected a unit direction");
    const Vec3 d(snapped(direction.x), snapped(direction.y), direction.z);
    const double r = std::hypot(d.x, d.y);
    std::optional<ReliefHit> hit;
    walk(relief, Vec2(from), Vec2(d), relief.reach / r, [&](const Patch& patch, const Vec2& at, double t0, double t1) {
        const double z = from.z + t0 * d.z;
        if (d.z >= 0 && z >= relief.high) return false;
        if (!patch.exists()) return true;
        const double u = descent(patch, at, z, d, t1 - t0);
        if (u < 0) return true;
        const Vec2 there = glm::clamp(at + u * Vec2(d), 0.0, 1.0);
        const double t = t0 + u;
        hit = {t * r, t, Vec3(from.x + t * d.x, from.y + t * d.y, patch.height(there)), patch.normal(there)};
        return false;
    });
    return hit;
}

}  // namespace nacre
