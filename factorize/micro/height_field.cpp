#include "factorize/micro/height_field.hpp"

#include <limits>

#include "core/error.hpp"

namespace nacre {

static constexpr double kMaxPeriods = 64;
static constexpr double kClearance = -1e-9;  // rounding, in cells: a ray may touch an edge it starts from

static int wrap(int i, int count) {
    const int rest = i % count;
    return rest < 0 ? rest + count : rest;
}

namespace {
/// Corner heights of a cell, in units of the cell's edge.
struct Corners {
    double h00, h10, h01, h11;
    double at(double u, double v) const {  // u ≥ v: the x side
        return u >= v ? h00 + u * (h10 - h00) + v * (h11 - h10) : h00 + v * (h01 - h00) + u * (h11 - h01);
    }
};
}  // namespace

static Corners cornersOf(const HeightField& field, int x, int y) {
    const int x0 = wrap(x, field.columns), y0 = wrap(y, field.rows);
    const int x1 = x0 + 1 == field.columns ? 0 : x0 + 1, y1 = y0 + 1 == field.rows ? 0 : y0 + 1;
    const auto height = [&](int i, int j) {
        return field.columns * field.heights[static_cast<std::size_t>(j * field.columns + i)];
    };
    return {height(x0, y0), height(x1, y0), height(x0, y1), height(x1, y1)};
}

std::vector<Facet> facetsOf(const HeightField& field) {
    const auto cells =
        static_cast<std::size_t>(std::max(field.columns, 0)) * static_cast<std::size_t>(std::max(field.rows, 0));
    require(cells > 0 && field.heights.size() == cells && field.albedo.size() == cells,
            "facetsOf: heights and albedo must hold columns x rows values");
    std::vector<Facet> out;
    const double edge = 1.0 / field.columns;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const int x = static_cast<int>(cell) % field.columns, y = static_cast<int>(cell) / field.columns;
        const Corners c = cornersOf(field, x, y);
        const Rgb& albedo = field.albedo[cell];
        require(std::isfinite(c.h00), "facetsOf: heights must be finite");
        require(std::min({albedo.r, albedo.g, albedo.b}) >= 0 && maxComponent(albedo) <= 1,
                "facetsOf: albedo must be in [0, 1]");
        const Vec3 a(x, y, c.h00), b(x + 1, y, c.h10), d(x, y + 1, c.h01), e(x + 1, y + 1, c.h11);
        for (const auto& [p, q] : {std::pair(b, e), std::pair(e, d)}) {
            const Vec3 normal = cross(p - a, q - a);
            const double doubleArea = glm::length(normal);
            out.push_back({(a + p + q) * (edge / 3), normal / doubleArea, doubleArea * edge * edge / 2, albedo});
        }
    }
    return out;
}

namespace {
/// A ray through the cells, in units of their edge.
class Marcher {
public:
    Marcher(const HeightField& field, double top, const Vec3& from, const Vec3& direction)
        : field_(field), from_(from * static_cast<double>(field.columns)), direction_(direction) {
        end_ = direction.z > 0 ? std::max(0.0, (top - from_.z) / direction.z) : std::numeric_limits<double>::infinity();
        const double run = std::hypot(direction.x, direction.y);
        if (run > 0) end_ = std::min(end_, kMaxPeriods * field.columns / run);
        x_ = static_cast<int>(std::floor(from_.x));
        y_ = static_cast<int>(std::floor(from_.y));
    }

    /// The triangle hit first, or -1.
    std::ptrdiff_t firstHit() {
        if (direction_.x == 0 && direction_.y == 0) return -1;
        for (double t = 0; t < end_;) {
            const double toX = crossing(from_.x, direction_.x, x_), toY = crossing(from_.y, direction_.y, y_);
            const double next = std::min(toX, toY);
            const std::ptrdiff_t hit = hitInCell(t, next);
            if (hit >= 0) return hit;
            (toX <= toY ? x_ : y_) += (toX <= toY ? direction_.x : direction_.y) > 0 ? 1 : -1;
            t = next;
        }
        return -1;
    }

private:
    static double crossing(double from, double direction, int cell) {
        if (direction == 0) return std::numeric_limits<double>::infinity();
        return (cell + (direction > 0 ? 1 : 0) - from) / direction;
    }
    std::ptrdiff_t triangle(double u, double v) const {
        const std::ptrdiff_t cell = wrap(y_, field_.rows) * field_.columns + wrap(x_, field_.columns);
        return 2 * cell + (v > u ? 1 : 0);
    }
    std::ptrdiff_t hitInCell(double enter, double leave) const {
        const Corners corners = cornersOf(field_, x_, y_);
        const double u0 = from_.x - x_, v0 = from_.y - y_;
        const auto below = [&](double t) {
            const double u = u0 + t * direction_.x, v = v0 + t * direction_.y;
            return from_.z + t * direction_.z - corners.at(u, v) < kClearance;
        };
        const auto triangleAt = [&](double t) { return triangle(u0 + t * direction_.x, v0 + t * direction_.y); };
        const double diagonal = (v0 - u0) / (direction_.x - direction_.y);  // where u = v; inf or NaN when never
        const bool crosses = diagonal > enter && diagonal < leave;
        if (crosses && below(diagonal)) return triangleAt(0.5 * (enter + diagonal));
        if (below(leave)) return triangleAt(0.5 * ((crosses ? diagonal : enter) + leave));
        return -1;
    }

    const HeightField& field_;
    Vec3 from_, direction_;
    double end_ = 0;
    int x_ = 0, y_ = 0;
};
}  // namespace

SurfaceTracer makeTracer(const HeightField& field) {
    const double top = field.columns * *std::max_element(field.heights.begin(), field.heights.end());
    const auto firstHit = [&field, top](const Vec3& from, const Vec3& direction) {
        return Marcher(field, top, from, direction).firstHit();
    };
    return {[firstHit](const Vec3& from, const Vec3& direction) { return firstHit(from, direction) < 0; }, firstHit};
}

HeightField flatField(const Rgb& albedo) { return {1, 1, {0.0}, {albedo}}; }

HeightField ridges(const RidgeShape& shape, int columns) {
    require(columns >= 2, "ridges: columns must be >= 2");
    require(shape.slope >= 0 && shape.peak > 0 && shape.peak < 1, "ridges: slope must be >= 0, peak in (0, 1)");
    HeightField out{columns, 1, {}, {}};
    const int crest = std::clamp(static_cast<int>(std::lround(shape.peak * columns)), 1, columns - 1);
    const double height = shape.slope * crest / columns;
    for (int x = 0; x < columns; ++x) {
        const bool rising = x < crest;
        out.heights.push_back(
            height * (rising ? x / static_cast<double>(crest) : (columns - x) / static_cast<double>(columns - crest)));
        out.albedo.push_back(rising ? shape.left : shape.right);
    }
    return out;
}

HeightField gaussianBumps(const BumpShape& shape, int columns) {
    require(columns >= 2 && shape.height >= 0 && shape.width > 0,
            "gaussianBumps: columns must be >= 2, height >= 0, width > 0");
    HeightField out{columns, columns, {}, {}};
    // Product of two bells, each lowered to 0 at the border where it meets its mirror image: continuous.
    const auto bell = [&](int i) {
        const auto gauss = [&](double d) { return std::exp(-0.5 * sqr(d / shape.width)); };
        return (gauss(static_cast<double>(i) / columns - 0.5) - gauss(0.5)) / (1 - gauss(0.5));
    };
    for (int y = 0; y < columns; ++y)
        for (int x = 0; x < columns; ++x) {
            out.heights.push_back(shape.height * bell(x) * bell(y));
            out.albedo.push_back(2 * x < columns ? shape.left : shape.right);
        }
    return out;
}

}  // namespace nacre
