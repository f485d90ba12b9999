#include <fmt/format.h>

#include <cmath>

#include "bench/environment_report.hpp"
#include "bench/html.hpp"
#include "bench/plot.hpp"
#include "bench/report.hpp"

namespace nacre::bench {

namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --ink: #1b1d22; --soft: #5b616e; --paper: #fbfaf8; --line: #dcd9d3; --good: #1a7f4b;
  --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e6e1; --soft: #a3a8b3; --paper: #16181c; --line: #363a42;
  --good: #6cc795; --bad: #f28b82; } }
body { margin: 0; background: var(--paper); color: var(--ink); font: 1rem/1.5 system-ui, "DejaVu Sans", sans-serif; }
main { max-width: 84rem; margin: 0 auto; padding: 1.2rem 1rem 4rem; }
h2 { margin: 2.4rem 0 .4rem; border-bottom: 1px solid var(--line); }
p { max-width: 50rem; } .soft { color: var(--soft); font-size: .88rem; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(26rem, 100%), 1fr)); gap: 1rem; }
svg.plot { width: 100%; height: auto; } svg text { fill: currentColor; font: 12px system-ui, "DejaVu Sans", sans-serif; }
svg .title { font-weight: 600; font-size: 13px; } svg .grid { stroke: var(--line); }
svg .reference { stroke: var(--ink); stroke-dasharray: 5 4; } svg .ring { fill: none; stroke: var(--ink); }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: .86rem; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: .2rem .6rem; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; } th { color: var(--soft); }
.PASS { color: var(--good); font-weight: 600; } .MISS { color: var(--bad); font-weight: 600; }
)css";

std::string ratioText(double ratio) { return ratio > 0 ? fmt::format("{:.2f}", ratio) : "–"; }

std::string barsSection(const Report& report) {
    if (report.bars.empty()) return {};
    std::string rows;
    for (const Bar& b : report.bars) {
        const std::string verdict = !b.measured ? "n/a" : b.pass() ? "PASS" : "MISS";
        rows += row({escaped(b.what), escaped(b.figure), fmt::format("{} {:g}", b.atLeast ? "≥" : "≤", b.limit),
                     b.measured ? fmt::format("{:.4g}", b.value) : "–",
                     fmt::format("<span class=\"{0}\">{0}</span>", verdict), escaped(b.worst)});
    }
    return "<h2>Bars</h2>\n" + table({"what", "figure", "bar", "measured", "", "decided by"}, rows);
}

/// Methods in the baker's order; auto last.
std::size_t colorOf(const std::string& method) {
    const std::vector<FactorizeMethod> all = factorizeMethods();
    const auto at = std::find_if(all.begin(), all.end(), [&](const FactorizeMethod& m) { return m.name == method; });
    return static_cast<std::size_t>(at - all.begin());
}

Plot plotOf(const std::vector<SettingSummary>& summaries, bool againstCost) {
    Plot plot;
    plot.title = againstCost ? "Error against cost" : "Error against bytes";
    plot.xLabel = againstCost ? "frame time ÷ that of direct evaluation" : "bytes of all textures";
    plot.yLabel = "E_L2 (median; line: range)";
    plot.markedLabel = "the paper's setting";
    if (againstCost) plot.reference = 1, plot.referenceLabel = "direct evaluation, no error";
    for (const SettingSummary& s : summaries) {
        const auto same = [&](const PlotSeries& p) { return p.name == s.setting.method; };
        auto at = std::find_if(plot.series.begin(), plot.series.end(), same);
        if (at == plot.series.end()) at = plot.series.insert(at, {s.setting.method, {}, colorOf(s.setting.method)});
        const double x = againstCost ? s.costRatio : s.bytes;
        if (x > 0)
            at->points.push_back(
                {x, s.l2, s.l2Low, s.l2High,
                 fmt::format("{}: {:.3g} %, {:.0f} bytes, {} fetches", text(s.setting), 100 * s.l2, s.bytes, s.fetches),
                 isPapersSetting(s.setting)});
    }
    return plot;
}

std::string summaryTable(const std::vector<SettingSummary>& summaries) {
    std::string rows;
    for (const SettingSummary& s : summaries)
        rows +=
            row({escaped(text(s.setting)) + (isPapersSetting(s.setting) ? " (the paper's)" : ""), s.form,
                 std::to_string(s.materials), std::to_string(s.fetches), fmt::format("{:.0f}", s.bytes), percent(s.l2),
                 percent(s.l2High), fmt::format("{:.3g}", s.logRms), percent(s.grazing), fmt::format("{:.1f}", s.psnr),
                 fmt::format("{:.1f}", s.psnrLow), ratioText(s.costRatio), fmt::format("{:.2f}", s.seconds)});
    return table({"setting", "form", "materials", "fetches", "bytes", "E_L2", "worst", "E_log", "E_L2 80–89°",
                  "sphere dB", "worst", "cost ratio", "bake s"},
                 rows);
}

std::string materialTable(const Report& report, Group group) {
    std::string rows;
    for (const Measurement& m : report.measurements)
        if (m.material.group == group)
            rows += row({escaped(m.material.name), escaped(text(m.setting)), escaped(m.textures),
                         std::to_string(m.fetches), std::to_string(m.bytes), percent(m.error.l2Rel),
                         fmt::format("{:.3g}", m.error.logRms), percent(m.error.maxRel), percent(m.error.grazingL2Rel),
                         fmt::format("{:.1f}", m.error.spherePsnr), fmt::format("{:.2g}", m.error.albedoMaxAbs),
                         ratioText(m.cost ? m.cost->ratio() : 0), fmt::format("{:.2f}", m.seconds)});
    return "<details><summary>Every material</summary>\n" +
           table({"material", "setting", "textures", "fetches", "bytes", "E_L2", "E_log", "max rel.", "E_L2 80–89°",
                  "sphere dB", "albedo", "cost ratio", "bake s"},
                 rows) +
           "</details>\n";
}

std::string groupSection(const Report& report, Group group) {
    const std::vector<SettingSummary> summaries = summarise(report.measurements, group);
    if (summaries.empty()) return {};
    std::string out =
        "<h2>" + escaped(title(group)) + "</h2>\n<div class=\"plots\">\n" + svgPlot(plotOf(summaries, false));
    if (!report.renderer.empty()) out += svgPlot(plotOf(summaries, true));
    return out + "</div>\n" + summaryTable(summaries) + materialTable(report, group);
}

constexpr const char* kBrdfWords =
    "<p>Reflectances factored into lookup textures: each point is one method at one setting: the median of the "
    "relative "
    "error E_L2 over the materials of its group, against the bytes of its textures, and against the time of a frame "
    "({}) as a multiple of the same frame with the model evaluated in the same shader. Measured tables have no such "
    "model; they are compared with Torrance–Sparrow. Frame times are medians of interleaved repeats. "
    "<code>reference/README.md</code> defines the errors.</p>\n";

std::string introduction(const Report& report) {
    std::string out = "<h1>nacre: speed against error</h1>\n";
    if (!report.measurements.empty()) out += fmt::format(kBrdfWords, GpuLab::frameText());
    out += fmt::format("<p class=\"soft\">nacre {}; {}; {}; {:.0f} s{}.</p>\n", escaped(report.version),
                       escaped(report.machine),
                       report.renderer.empty() ? "no OpenGL: cost not measured" : escaped(report.renderer),
                       report.seconds, report.quick ? "; a quick run: few inputs and settings" : "");
    for (const std::string& note : report.notes) out += "<p class=\"soft\">" + escaped(note) + "</p>\n";
    return out;
}

}  // namespace

std::string reportPage(const Report& report) {
    std::string out =
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"><title>nacre: speed against error</title><style>";
    out += std::string(kStyle) + "</style></head><body><main>\n" + introduction(report) + barsSection(report);
    for (const Group group : kGroups) out += groupSection(report, group);
    return out + environmentSection(report.environments) + bumpSection(report.bumps) + shadowSection(report.shadows) +
           transferSection(report.transfers) + specularSection(report.speculars) + hybridSection(report.hybrid) +
           "</main></body></html>\n";
}

}  // namespace nacre::bench
