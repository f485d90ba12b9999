#include <algorithm>

#include "bench/html.hpp"
#include "bench/plot.hpp"
#include "bench/transfer_sweep.hpp"

namespace nacre::bench {

nlohmann::json transferJson(const TransferMeasurement& m) {
    return {{"mesh", m.mesh},
            {"method", m.method},
            {"setting", m.setting},
            {"vertices", m.vertices},
            {"vertices_per_second", m.verticesPerSecond()},
            {"blockers", {{"listed", m.listed}, {"drawn", m.drawn}}},
            {"error", {{"l2_rel", m.error}, {"total", m.total}, {"truth", m.noise}}},
            {"cpu_seconds", m.cpuSeconds},
            {"wall_seconds", m.wallSeconds},
            {"seconds",
             {{"rasterization", m.seconds.rasterization},
              {"integration", m.seconds.integration},
              {"transform", m.seconds.transform},
              {"other", m.seconds.other}}}};
}

namespace {

bool isPapersSetting(const TransferMeasurement& m) {
    return m.method == "HEMI" && m.setting == text(PaperMethodOptions{});
}

Plot plotOf(const std::vector<TransferMeasurement>& all, const std::string& mesh) {
    Plot plot;
    plot.title = mesh;
    plot.xLabel = "vertices a second, two threads";
    plot.yLabel = "mean relative L2 error";
    plot.markedLabel = "the paper's setting";
    const std::vector<std::string> methods = {"nacre", "HEMI", "HEMI, blocks' means", "Embree"};
    for (std::size_t i = 0; i < methods.size(); ++i) plot.series.push_back({methods[i], {}, i});
    for (const TransferMeasurement& m : all) {
        const auto method = std::find(methods.begin(), methods.end(), m.method);
        if (m.mesh != mesh || method == methods.end()) continue;
        plot.series[static_cast<std::size_t>(method - methods.begin())].points.push_back(
            {m.verticesPerSecond(), m.error, m.error, m.error,
             fmt::format("{}, {}: {} at {:.3g} million vertices/s", m.method, m.setting, percent(m.error),
                         m.verticesPerSecond() / 1e6),
             isPapersSetting(m)});
    }
    return plot;
}

}  // namespace

std::string transferSection(const std::vector<TransferMeasurement>& measurements) {
    if (measurements.empty()) return {};
    std::vector<std::string> meshes;
    std::string rows;
    for (const TransferMeasurement& m : measurements) {
        if (std::find(meshes.begin(), meshes.end(), m.mesh) == meshes.end()) meshes.push_back(m.mesh);
        rows += row({escaped(m.mesh), escaped(m.method), escaped(m.setting), std::to_string(m.vertices),
                     fmt::format("{:.0f}", m.listed), fmt::format("{:.0f}", m.drawn), percent(m.error),
                     percent(m.total), percent(m.noise), fmt::format("{:.3g}", m.verticesPerSecond() / 1e6),
                     fmt::format("{:.3g}", 1e3 * m.cpuSeconds), fmt::format("{:.3g}", 1e3 * m.wallSeconds)});
    }
    std::string out =
        "<h2>Soft self-shadows of moving meshes</h2>\n<p>Light transfer of every vertex in every frame, 25 harmonics, "
        "nothing precomputed. Error: mean over vertices and frames of the transfer vector's relative L2 error against "
        "many rays. Vertices a second: of CPU seconds of all threads, as if two threads had two processors; medians of "
        "interleaved repeats. HEMI: the paper's own algorithm, made fast (transfer/paper_method.hpp). Embree: its "
        "fastest setting, the scene rebuilt in every frame.</p>\n<div class=\"plots\">\n";
    for (const std::string& mesh : meshes) out += svgPlot(plotOf(measurements, mesh));
    return out + "</div>\n<details><summary>Every measurement</summary>\n" +
           table({"mesh", "method", "setting", "vertices", "listed", "drawn", "mean error", "total error",
                  "of the truth", "million vertices/s", "CPU ms a frame", "wall ms"},
                 rows) +
           "</details>\n";
}

}  // namespace nacre::bench
