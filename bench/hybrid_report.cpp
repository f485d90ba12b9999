
#include "bench/html.hpp"
#include "bench/hybrid_sweep.hpp"
#include "bench/plot.hpp"

namespace nacre::bench {
namespace {

/// HYBRID table 2 as printed: pipes, shadow, indirect, direct, specular, composite [%], seconds by hardware and
/// software.
struct PaperRow {
    const char* scene;
    int pipes;
    double shares[5], hardware, software;
};
constexpr PaperRow kTable2[] = {{"office", 2, {65.38, 20.01, 6.306, 2.692, 4.173}, 0.4061, 0.4041},
                                {"office", 4, {46.65, 26.63, 9.883, 3.136, 11.34}, 0.2961, 0.2625},
                                {"office", 8, {28.22, 28.00, 11.39, 4.141, 25.79}, 0.2565, 0.2093},
                                {"classroom", 4, {80.16, 6.336, 2.604, 2.440, 7.447}, 0.4816, 0.4372},
                                {"classroom", 8, {61.16, 10.63, 4.490, 3.967, 18.10}, 0.2937, 0.2490},
                                {"Cornell box", 1, {73.10, 17.49, 2.945, 6.299, 0.02277}, 0.293, 0.3175},
                                {"Cornell box", 2, {50.98, 24.11, 4.173, 5.731, 14.73}, 0.2093, 0.1981},
                                {"Cornell box", 4, {29.22, 31.17, 4.780, 6.830, 27.73}, 0.1751, 0.1444},
                                {"Cornell box", 8, {14.98, 31.56, 5.158, 6.683, 41.27}, 0.1650, 0.1322}};

std::string shareText(double share) { return fmt::format("{:.1f} %", 100 * share); }

std::string tableTwo(const std::vector<PipeMeasurement>& measured) {
    std::string rows;
    for (const PipeMeasurement& m : measured) {
        std::vector<std::string> cells{"25 rings, here", std::to_string(m.pipes), escaped(m.compositing), m.threads};
        for (const double share : m.shares) cells.push_back(shareText(share));
        cells.push_back(fmt::format("{:.4f}", m.seconds));
        rows += row(cells);
    }
    for (const PaperRow& p : kTable2) {
        std::vector<std::string> cells{fmt::format("{}, the paper", p.scene), std::to_string(p.pipes), "both", "–"};
        for (const double share : p.shares) cells.push_back(shareText(share / 100));
        cells.push_back(fmt::format("{:.4f}, {:.4f}", p.hardware, p.software));
        rows += row(cells);
    }
    return table({"scene", "pipes", "compositing", "rasterizer threads a pipe", "shadow", "indirect", "direct",
                  "specular", "composite", "s a frame"},
                 rows);
}

Plot plotOf(const std::vector<HybridMeasurement>& all, const std::string& knob) {
    Plot plot;
    plot.title = knob == "virtual-lights" ? "Cornell box, one bounce" : "Soft shadows by volumes";
    plot.xLabel = "seconds a frame of 512 × 512";
    plot.yLabel = "relative RMSE of the stage";
    PlotSeries series{knob, {}, 0};
    for (const HybridMeasurement& m : all)
        if (m.knob == knob)
            series.points.push_back({m.seconds, m.error, m.error, m.error,
                                     fmt::format("{} {}: {}", m.value, m.knob, percent(m.error)),
                                     m.value == (knob == "virtual-lights" ? 64 : 16)});
    plot.markedLabel = "the default";
    plot.series = {series};
    return plot;
}

}  // namespace

std::string hybridSection(const HybridSweep& sweep) {
    if (sweep.pipes.empty()) return {};
    return "<h2>Hybrid rendering</h2>\n<p>Error of a stage against rays over the time of a frame by one pipe. Below, "
           "HYBRID's table 2: the share of a frame's time that each pass has, in the first pipe; composite contains "
           "its wait for the others. Shadow is making and counting volumes and each point's light outside them. Pipes "
           "are processes; with one, all cores are its rasterizer threads'.</p>\n<div class=\"plots\">\n" +
           svgPlot(plotOf(sweep.errors, "virtual-lights")) + svgPlot(plotOf(sweep.errors, "light-points")) +
           "</div>\n" + tableTwo(sweep.pipes);
}

nlohmann::json hybridJson(const HybridSweep& sweep) {
    nlohmann::json out = {{"errors", nlohmann::json::array()}, {"pipes", nlohmann::json::array()}};
    for (const HybridMeasurement& m : sweep.errors)
        out["errors"].push_back({{"scene", m.scene},
                                 {"stage", m.stage},
                                 {"knob", m.knob},
                                 {"value", m.value},
                                 {"error", m.error},
                                 {"seconds", m.seconds}});
    for (const PipeMeasurement& m : sweep.pipes) {
        nlohmann::json shares;
        for (std::size_t i = 0; i < kHybridPasses.size(); ++i) shares[kHybridPasses[i]] = m.shares[i];
        out["pipes"].push_back({{"pipes", m.pipes},
                                {"compositing", m.compositing},
                                {"rasterizer_threads", m.threads},
                                {"seconds", m.seconds},
                                {"shares", shares}});
    }
    return out;
}

}  // namespace nacre::bench
