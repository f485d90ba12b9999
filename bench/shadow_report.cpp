#include <algorithm>

#include "bench/html.hpp"
#include "bench/plot.hpp"
#include "bench/shadow_sweep.hpp"

namespace nacre::bench {

nlohmann::json shadowJson(const ShadowMeasurement& m) {
    return {{"scene", m.scene},        {"light", m.light}, {"method", m.method},         {"setting", m.setting},
            {"size", m.size},          {"bits", m.bits},   {"near_to_far", m.nearToFar}, {"usual", m.usual},
            {"acne", m.acne},          {"leaks", m.leaks}, {"boundary", m.boundary},     {"bytes", m.bytes},
            {"update_ms", m.updateMs}, {"frame", m.frame}};
}

namespace {

PlotSeries& seriesOf(Plot& plot, const std::string& name) {
    for (PlotSeries& s : plot.series)
        if (s.name == name) return s;
    plot.series.push_back({name, {}, plot.series.size()});
    return plot.series.back();
}

PlotPoint pointOf(const ShadowMeasurement& m, double x) {
    const double y = m.misjudged();
    return {x,
            y,
            y,
            y,
            fmt::format("{}, {}, {}: {} acne, {} leaks, {} at boundaries", m.method, m.light, m.setting,
                        percent(m.acne), percent(m.leaks), percent(m.boundary)),
            m.usual};
}

/// A light's maps of one scene: everything misjudged against texels.
Plot sizePlot(const std::vector<ShadowMeasurement>& all, const std::string& scene, const std::string& light) {
    Plot plot;
    plot.title = scene + ", " + light;
    plot.xLabel = "texels along an edge";
    plot.yLabel = "pixels misjudged";
    plot.markedLabel = "a scene file's usual";
    for (const ShadowMeasurement& m : all)
        if (m.scene == scene && m.light == light && m.nearToFar == 0)
            seriesOf(plot, m.method).points.push_back(pointOf(m, m.size));
    return plot;
}

Plot timePlot(const std::vector<ShadowMeasurement>& all, const std::string& scene) {
    Plot plot;
    plot.title = scene + ": time of a frame";
    plot.xLabel = "times the unshadowed frame's";
    plot.yLabel = "pixels misjudged";
    plot.markedLabel = "a scene file's usual";
    for (const ShadowMeasurement& m : all)
        if (m.scene == scene && m.frame > 0) seriesOf(plot, m.method).points.push_back(pointOf(m, m.frame));
    return plot;
}

/// Acne and leaks off boundaries of the depth codes over bits, one series a code and ratio.
Plot codePlot(const std::vector<ShadowMeasurement>& all, bool hyperbolic) {
    Plot plot;
    plot.title = hyperbolic ? "A z-buffer's depth" : "Linear depth";
    plot.xLabel = "bits";
    plot.yLabel = "acne and leaks off boundaries, 1e-6 added";
    for (const ShadowMeasurement& m : all) {
        if (m.nearToFar == 0 || (m.method == "z-buffer, traced") != hyperbolic) continue;
        PlotPoint point = pointOf(m, m.bits);
        point.y = point.low = point.high = m.acne + m.leaks + 1e-6;
        seriesOf(plot, fmt::format("near/far 1/{:g}", 1 / m.nearToFar)).points.push_back(point);
    }
    return plot;
}

}  // namespace

std::string shadowSection(const std::vector<ShadowMeasurement>& measurements) {
    if (measurements.empty()) return {};
    std::vector<std::pair<std::string, std::string>> cases;
    std::vector<std::string> timed;
    std::string rows;
    for (const ShadowMeasurement& m : measurements) {
        const std::pair key{m.scene, m.light};
        if (m.nearToFar == 0 && std::find(cases.begin(), cases.end(), key) == cases.end()) cases.push_back(key);
        if (m.frame > 0 && std::find(timed.begin(), timed.end(), m.scene) == timed.end()) timed.push_back(m.scene);
        rows += row({escaped(m.scene), escaped(m.light), m.method, m.setting, percent(m.acne), percent(m.leaks),
                     percent(m.boundary), fmt::format("{:.3g}", m.bytes / 1e6), fmt::format("{:.3g}", m.updateMs),
                     fmt::format("{:.3g}", m.frame)});
    }
    std::string out =
        "<h2>Shadow maps</h2>\n<p>Each visible point that faces the light is lit or not, as a ray to the light says. "
        "Shown is the share of such pixels on which a map decides otherwise. Acne: lit, called shadowed; leaks: "
        "shadowed, called lit; both where no true shadow edge lies within the filter. The rest is at boundaries, which "
        "texels can't resolve. The alpha test is HSE section 2.1's method. Traced maps hold one ray a texel, rounded "
        "in "
        "a code: linear, or a z-buffer's.</p>\n<div class=\"plots\">\n";
    for (const auto& [scene, light] : cases) out += svgPlot(sizePlot(measurements, scene, light));
    for (const std::string& scene : timed) out += svgPlot(timePlot(measurements, scene));
    out += svgPlot(codePlot(measurements, false)) + svgPlot(codePlot(measurements, true));
    return out + "</div>\n<details><summary>Every measurement</summary>\n" +
           table({"scene", "light", "method", "setting", "acne", "leaks", "at boundaries", "MB", "ms to draw",
                  "times unshadowed"},
                 rows) +
           "</details>\n";
}

}  // namespace nacre::bench
