#include <algorithm>

#include "bench/html.hpp"
#include "bench/plot.hpp"
#include "bench/specular_sweep.hpp"

namespace nacre::bench {

nlohmann::json specularJson(const SpecularMeasurement& m) {
    return {{"scene", m.scene}, {"knob", m.knob},     {"setting", m.setting},    {"usual", m.usual},
            {"ms", m.ms},       {"psnr", m.psnr},     {"traced_ms", m.tracedMs}, {"rms_over_mean", m.rmsOverMean},
            {"views", m.views}, {"passes", m.passes}, {"lights", m.lights}};
}

namespace {

PlotSeries& seriesOf(Plot& plot, const std::string& name) {
    for (PlotSeries& s : plot.series)
        if (s.name == name) return s;
    plot.series.push_back({name, {}, plot.series.size()});
    return plot.series.back();
}

/// Without an error there is no place on a logarithmic axis.
constexpr double kLeastError = 1e-6;

Plot plotOf(const std::vector<SpecularMeasurement>& all, const std::string& scene, const std::string& knob) {
    Plot plot;
    plot.title = scene + ": " + knob;
    plot.xLabel = "ms a picture";
    plot.yLabel = "RMS / mean, 1e-6 added";
    plot.markedLabel = "usual";
    for (const SpecularMeasurement& m : all) {
        if (m.scene != scene || m.knob != knob) continue;
        const bool random = m.setting.find("random") != std::string::npos;
        const double y = m.rmsOverMean + kLeastError;
        seriesOf(plot, random ? "passes, random" : "passes").points.push_back({m.ms, y, y, y, m.setting, m.usual});
        if (m.usual) plot.reference = m.tracedMs, plot.referenceLabel = "our rays, usual setting";
    }
    return plot;
}

}  // namespace

std::string specularSection(const std::vector<SpecularMeasurement>& measurements) {
    if (measurements.empty()) return {};
    std::vector<std::pair<std::string, std::string>> cases;
    std::string rows;
    for (const SpecularMeasurement& m : measurements) {
        const std::pair key{m.scene, m.knob};
        if (std::find(cases.begin(), cases.end(), key) == cases.end()) cases.push_back(key);
        rows += row({escaped(m.scene), m.knob, m.setting, percent(m.rmsOverMean), fmt::format("{:.2f}", m.psnr),
                     fmt::format("{:.4g}", m.ms), fmt::format("{:.4g}", m.tracedMs),
                     fmt::format("{:.3g}", m.tracedMs / m.ms), fmt::format("{}", m.views), fmt::format("{}", m.passes),
                     fmt::format("{}", m.lights)});
    }
    std::string out =
        "<h2>Pictures in many passes</h2>\n<p>Mirrors, panes and the light that they send on, drawn by passes (MPR, "
        "PR94) and traced by our reference, one sample in each pixel's middle for both. The error is against rays with "
        "all depths; the reference's time is with the setting's own depths and samples, on all cores.</p>\n<div "
        "class=\"plots\">\n";
    for (const auto& [scene, knob] : cases) out += svgPlot(plotOf(measurements, scene, knob));
    return out + "</div>\n<details><summary>Every measurement</summary>\n" +
           table({"scene", "knob", "setting", "RMS / mean", "PSNR [dB]", "ms", "ms traced", "times faster", "views",
                  "passes", "lights"},
                 rows) +
           "</details>\n";
}

}  // namespace nacre::bench
