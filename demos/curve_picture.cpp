#include "demos/curve_picture.hpp"

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr int kMargin = 8;

struct Range {
    double low = 1e300, high = -1e300;
    void add(double v) { low = std::min(low, v), high = std::max(high, v); }
    double share(double v) const { return high > low ? (v - low) / (high - low) : 0.5; }
};

/// A line two pixels wide.
void line(Image& image, const Vec2& a, const Vec2& b, const Curve& curve) {
    const int steps = std::max(1, static_cast<int>(2 * glm::length(b - a)));
    for (int i = 0; i <= steps; ++i) {
        const Vec2 p = a + (b - a) * (double(i) / steps);
        const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
        if (curve.dashed && (x / 5) % 2 == 1) continue;
        for (int v = y; v < y + 2; ++v)
            if (x >= 0 && x < image.width() && v >= 0 && v < image.height()) image.setRgb(x, v, curve.color);
    }
}

}  // namespace

Image curvePicture(const std::vector<Curve>& curves, int size) {
    Range xs, ys;
    ys.add(0);
    for (const Curve& c : curves) {
        require(c.x.size() == c.y.size(), "curvePicture: as many x as y");
        for (const double v : c.x) xs.add(v);
        for (const double v : c.y) ys.add(v);
    }
    require(size > 20 && xs.high >= xs.low, "curvePicture: expected a point, and more than 20 pixels");
    Image out(size, size, 3);
    const auto place = [&](double x, double y) {
        const double span = size - 2 * kMargin;
        return Vec2(kMargin + span * xs.share(x), size - kMargin - span * ys.share(y));
    };
    for (int i = 0; i <= 10; ++i) {
        const double x = xs.low + (xs.high - xs.low) * i / 10, y = ys.high * i / 10;
        const Curve grey{{}, {}, Rgb(i == 0 ? 0.3 : 0.03)};
        line(out, place(x, 0), place(x, ys.high), grey);
        line(out, place(xs.low, y), place(xs.high, y), grey);
    }
    for (const Curve& c : curves)
        for (std::size_t i = 1; i < c.x.size(); ++i) line(out, place(c.x[i - 1], c.y[i - 1]), place(c.x[i], c.y[i]), c);
    return out;
}

}  // namespace nacre
