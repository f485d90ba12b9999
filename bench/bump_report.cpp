#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/bump_sweep.hpp"
#include "bench/html.hpp"
#include "bench/plot.hpp"

namespace nacre::bench {

using nlohmann::json;

json bumpJson(const BumpMeasurement& m) {
    return {{"relief", m.relief},
            {"method", m.method},
            {"setting", m.setting},
            {"texels", m.texels},
            {"usual", m.usual},
            {"bytes_a_texel", m.bytesATexel},
            {"cpu_seconds", m.cpuSeconds},
            {"wall_seconds", m.wallSeconds},
            {"misjudged", m.misjudged},
            {"detail", m.detail}};
}

namespace {

constexpr const char* kMethods[] = {"ellipses", "ellipses, radii only", "horizon map", "scatter map", "bounced light"};

std::size_t colorOf(const std::string& method) {
    return static_cast<std::size_t>(std::find(std::begin(kMethods), std::end(kMethods), method) - kMethods);
}

PlotSeries& seriesOf(Plot& plot, const std::string& method) {
    for (PlotSeries& s : plot.series)
        if (s.name == method) return s;
    plot.series.push_back({method, {}, colorOf(method)});
    return plot.series.back();
}

bool isSized(const BumpMeasurement& m) { return m.relief.rfind("synthetic ", 0) == 0; }

Plot shadowPlot(const std::vector<BumpMeasurement>& all, const std::string& relief, bool againstTime) {
    Plot plot;
    plot.title = "Shadows, " + relief;
    plot.xLabel = againstTime ? "CPU-seconds of the bake" : "bytes a texel";
    plot.yLabel = "texels and lights misjudged";
    plot.markedLabel = "the command's usual, the paper's";
    for (const BumpMeasurement& m : all) {
        if (m.relief != relief || m.method == "scatter map" || m.method == "bounced light") continue;
        const double x = againstTime ? m.cpuSeconds : m.bytesATexel;
        seriesOf(plot, m.method)
            .points.push_back(
                {x, m.misjudged, m.misjudged, m.misjudged,
                 fmt::format("{}, {}: {}, {:.3g} CPU-s", m.method, m.setting, percent(m.misjudged), m.cpuSeconds),
                 m.usual});
    }
    return plot;
}

Plot lightPlot(const std::vector<BumpMeasurement>& all) {
    Plot plot;
    plot.title = "Light of three bounces, albedo 0.7: 12 to 400 paths";
    plot.xLabel = "CPU-seconds a light";
    plot.yLabel = "relative rmse of all light";
    plot.markedLabel = "100 paths, the command's usual";
    for (const BumpMeasurement& m : all) {
        if (m.method != "bounced light") continue;
        PlotSeries* series = nullptr;
        for (PlotSeries& s : plot.series)
            if (s.name == m.relief) series = &s;
        if (!series) series = &plot.series.emplace_back(PlotSeries{m.relief, {}, plot.series.size()});
        series->points.push_back({m.cpuSeconds, m.misjudged, m.misjudged, m.misjudged,
                                  fmt::format("{}, {}: {}, without direct light {}", m.relief, m.setting,
                                              percent(m.misjudged), percent(m.detail)),
                                  m.usual});
    }
    return plot;
}

Plot timePlot(const std::vector<BumpMeasurement>& all) {
    Plot plot;
    plot.title = "Seconds against texels: 16 azimuths, 64 rays, ellipses of 128 directions";
    plot.xLabel = "texels";
    plot.yLabel = "CPU-seconds";
    for (const BumpMeasurement& m : all)
        if (isSized(m))
            seriesOf(plot, m.method)
                .points.push_back(
                    {static_cast<double>(m.texels), m.cpuSeconds, m.cpuSeconds, m.cpuSeconds,
                     fmt::format("{}, {}: {:.3g} CPU-s, {:.3g} s", m.relief, m.setting, m.cpuSeconds, m.wallSeconds)});
    return plot;
}

}  // namespace

std::string bumpSection(const std::vector<BumpMeasurement>& measurements) {
    if (measurements.empty()) return {};
    std::vector<std::string> reliefs;
    std::string rows;
    for (const BumpMeasurement& m : measurements) {
        if (!isSized(m) && std::find(reliefs.begin(), reliefs.end(), m.relief) == reliefs.end())
            reliefs.push_back(m.relief);
        rows += row({escaped(m.relief), m.method, m.setting, fmt::format("{}", m.texels),
                     fmt::format("{:g}", m.bytesATexel), fmt::format("{:.3g}", m.cpuSeconds),
                     fmt::format("{:.3g}", m.wallSeconds), percent(m.misjudged), fmt::format("{:.3g}", m.detail)});
    }
    std::string out =
        "<h2>Bump: shadows of reliefs</h2>\n<p>A light either reaches a texel or it doesn't: each point is the share "
        "of "
        "random texels and lights, weighted by the cosine, at which a representation decides otherwise than exact "
        "rays over the bilinear surface do. One ellipse a texel costs 12 bytes and one test; a horizon map costs two "
        "bytes an azimuth. Scatter maps hold what a texel sees, for light that bounces: of them the table has the "
        "share of rays whose hit or miss is wrong, and of those beyond one texel; of the light, its error with and "
        "without the direct light.</p>\n<div class=\"plots\">\n";
    for (const std::string& relief : reliefs)
        for (const bool againstTime : {false, true}) out += svgPlot(shadowPlot(measurements, relief, againstTime));
    out += svgPlot(lightPlot(measurements)) + svgPlot(timePlot(measurements));
    return out + "</div>\n<details><summary>Every measurement</summary>\n" +
           table({"relief", "method", "setting", "texels", "bytes a texel", "CPU-s", "s", "misjudged",
                  "rmse [°], beyond a texel, or bounced alone"},
                 rows) +
           "</details>\n";
}

}  // namespace nacre::bench
