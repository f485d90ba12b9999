#include "bench/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nacre::bench {

namespace {

constexpr double kWidth = 640, kHeight = 430, kLeft = 66, kRight = 14, kTop = 34, kBottom = 48, kLegendRow = 17;
// Eight hues that stay apart for colour-blind readers (Okabe & Ito 2008; black replaced by grey).
constexpr std::array<const char*, 8> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#8c8c8c", "#6a3d9a"};

const char* colorOf(const PlotSeries& series) { return kColors[series.color % kColors.size()]; }

bool drawable(const PlotPoint& p) { return std::isfinite(p.x) && std::isfinite(p.y) && p.x > 0 && p.y > 0; }

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return out;
}

/// A logarithmic axis: value to pixel.
struct Axis {
    double low = std::numeric_limits<double>::infinity(), high = 0, from = 0, to = 1;
    void include(double v) { low = std::min(low, v), high = std::max(high, v); }
    void finish(double pixelFrom, double pixelTo) {
        if (high <= 0) low = 0.1, high = 10;
        const double margin = std::max(1.15, std::pow(high / low, 0.04));
        low /= margin, high *= margin, from = pixelFrom, to = pixelTo;
    }
    double at(double v) const { return from + (to - from) * std::log(v / low) / std::log(high / low); }
    /// 1, 2, 5 times powers of ten, or powers alone when these would crowd.
    std::vector<double> ticks() const {
        std::vector<double> out;
        const bool wide = high / low > 2000;
        for (int e = static_cast<int>(std::floor(std::log10(low))); e <= std::log10(high); ++e)
            for (const double m : {1., 2., 5.})
                if (const double v = m * std::pow(10., e); v >= low && v <= high && (m == 1 || !wide)) out.push_back(v);
        return out;
    }
};

struct Axes {
    Axis x, y;
    explicit Axes(const Plot& plot) {
        for (const PlotSeries& s : plot.series)
            for (const PlotPoint& p : s.points)
                if (drawable(p)) x.include(p.x), y.include(p.y);
        if (plot.reference) x.include(*plot.reference);
        x.finish(kLeft, kWidth - kRight);
        y.finish(kHeight - kBottom, kTop);
    }
    double yAt(double v) const { return std::clamp(y.at(std::max(v, 1e-300)), kTop, kHeight - kBottom); }
};

std::string number(double v) { return v >= 1e4 ? fmt::format("{:g}k", v / 1000) : fmt::format("{:g}", v); }

std::string gridAndTicks(const Axes& axes) {
    std::string out;
    for (const double v : axes.x.ticks())
        out += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
            "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
            axes.x.at(v), kTop, kHeight - kBottom, kHeight - kBottom + 16, number(v));
    for (const double v : axes.y.ticks())
        out += fmt::format(
            "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
            "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
            kLeft, kWidth - kRight, axes.y.at(v), kLeft - 6, axes.y.at(v) + 4, number(v));
    return out;
}

std::string labels(const Plot& plot) {
    const double middle = (kTop + kHeight - kBottom) / 2;
    return fmt::format("<text class=\"title\" x=\"{}\" y=\"16\">{}</text>\n", kLeft, escaped(plot.title)) +
           fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (kLeft + kWidth - kRight) / 2,
                       kHeight - 12, escaped(plot.xLabel)) +
           fmt::format("<text x=\"14\" y=\"{0}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {0})\">{1}</text>\n",
                       middle, escaped(plot.yLabel));
}

std::string referenceLine(const Plot& plot, const Axes& axes) {
    if (!plot.reference) return {};
    const double x = axes.x.at(*plot.reference);
    const bool right = x > kWidth / 2;
    return fmt::format(
        "<line class=\"reference\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text x=\"{3:.1f}\" y=\"{4}\" text-anchor=\"{5}\">{6}</text>\n",
        x, kTop, kHeight - kBottom, x + (right ? -5 : 5), kHeight - kBottom - 6, right ? "end" : "start",
        escaped(plot.referenceLabel));
}

/// From left to right the points that lower the error.
std::string frontier(std::vector<PlotPoint> points, const Axes& axes, const char* color) {
    std::sort(points.begin(), points.end(),
              [](const PlotPoint& a, const PlotPoint& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::string path;
    double best = std::numeric_limits<double>::infinity();
    for (const PlotPoint& p : points) {
        if (!drawable(p) || p.y >= best) continue;
        best = p.y;
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", axes.x.at(p.x), axes.y.at(p.y));
    }
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" opacity=\"0.75\"/>\n", path,
                       color);
}

std::string dots(const PlotSeries& series, const Axes& axes, const char* color) {
    std::string out;
    for (const PlotPoint& p : series.points) {
        if (!drawable(p)) continue;
        const double x = axes.x.at(p.x), y = axes.y.at(p.y);
        if (p.high > p.low)
            out += fmt::format(
                "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\" opacity=\"0.3\"/>", x,
                axes.yAt(p.low), axes.yAt(p.high), color);
        if (p.marked) out += fmt::format("<circle class=\"ring\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/>", x, y);
        out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"><title>{}</title></circle>\n", x, y,
                           color, escaped(p.label));
    }
    return out;
}

std::string legend(const Plot& plot) {
    std::string out;
    double y = kHeight + 6;
    double x = kLeft;
    const auto entry = [&](const std::string& mark, const std::string& name) {
        const double width = 26 + 7.2 * static_cast<double>(name.size());
        if (x + width > kWidth && x > kLeft) x = kLeft, y += kLegendRow;
        out += fmt::format("<g transform=\"translate({:.0f} {:.0f})\">{}<text x=\"14\" y=\"4\">{}</text></g>\n", x, y,
                           mark, escaped(name));
        x += width;
    };
    bool marked = false;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        entry(fmt::format("<circle cx=\"4\" cy=\"0\" r=\"4\" fill=\"{}\"/>", colorOf(plot.series[i])),
              plot.series[i].name);
        for (const PlotPoint& p : plot.series[i].points) marked |= p.marked && drawable(p);
    }
    if (marked) entry("<circle class=\"ring\" cx=\"4\" cy=\"0\" r=\"6\"/>", plot.markedLabel);
    return fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {:.0f}\" role=\"img\" aria-label=\"{}\">\n", kWidth,
                       y + 14, escaped(plot.title)) +
           out;
}

}  // namespace

std::string svgPlot(const Plot& given) {
    Plot plot = given;
    std::size_t left = 0;
    for (const PlotSeries& s : plot.series)
        left += static_cast<std::size_t>(
            std::count_if(s.points.begin(), s.points.end(), [](const PlotPoint& p) { return !drawable(p); }));
    if (left > 0) plot.title += fmt::format(" ({} without a place on it)", left);
    const Axes axes(plot);
    std::string out = legend(plot) + gridAndTicks(axes) + labels(plot) + referenceLine(plot, axes);
    for (std::size_t i = 0; i < plot.series.size(); ++i)
        out += frontier(plot.series[i].points, axes, colorOf(plot.series[i]));
    for (std::size_t i = 0; i < plot.series.size(); ++i) out += dots(plot.series[i], axes, colorOf(plot.series[i]));
    return out + "</svg>\n";
}

}  // namespace nacre::bench
