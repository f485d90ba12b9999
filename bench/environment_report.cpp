#include "bench/environment_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/bars.hpp"
#include "bench/html.hpp"
#include "bench/plot.hpp"

namespace nacre::bench {

using nlohmann::json;

json environmentJson(const EnvironmentMeasurement& m) {
    json levels = json::array();
    for (const LevelMeasurement& l : m.levels)
        levels.push_back({{"lobe", toString(l.level.lobe.kind)},
                          {"exponent", l.level.lobe.exponent},
                          {"alpha", l.level.lobe.alpha},
                          {"size", l.level.size},
                          {"rmse", l.error.rmse},
                          {"p95", l.error.p95},
                          {"max", l.error.max},
                          {"filtered_rmse", l.error.filteredRmse},
                          {"samples", l.error.samples}});
    return {{"surrounding", m.surrounding},
            {"chain", toString(m.chain)},
            {"source_size", m.sourceSize},
            {"method", m.method},
            {"setting", m.setting},
            {"usual", m.usual},
            {"cpu_seconds", m.cpuSeconds},
            {"projected", m.projected},
            {"worst_rmse", m.worstRmse()},
            {"direct_cpu_seconds", m.directSeconds},
            {"levels", levels}};
}

namespace {

constexpr const char* kMethods[] = {"nacre", "importance, mips", "importance", "sums, reduced", "GPU"};

std::size_t colorOf(const std::string& method) {
    return static_cast<std::size_t>(std::find(std::begin(kMethods), std::end(kMethods), method) - kMethods);
}

using Measurements = std::vector<const EnvironmentMeasurement*>;

/// One setting over all surroundings: medians and the range of the error.
PlotPoint pointOf(const Measurements& list) {
    std::vector<double> seconds, errors;
    for (const EnvironmentMeasurement* m : list) seconds.push_back(m->cpuSeconds), errors.push_back(m->worstRmse());
    const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
    const double x = median(seconds), y = median(errors);
    const EnvironmentMeasurement& first = *list.front();
    return {x,
            y,
            *low,
            *high,
            fmt::format("{}, {}: {:.3g} %, {:.3g} CPU-s{}", first.method, first.setting, 100 * y, x,
                        first.projected ? " (projected)" : ""),
            first.usual};
}

Plot plotOf(const Measurements& all, Chain chain, int size) {
    Plot plot;
    plot.title = fmt::format("{}, source {}", toString(chain), size);
    plot.xLabel = "CPU-seconds of the chain";
    plot.yLabel = "rmse of the worst level (median of maps; line: range)";
    plot.markedLabel = "a tool's usual setting";
    std::vector<double> direct;
    std::vector<std::pair<std::string, std::string>> settings;  // in order of appearance
    for (const EnvironmentMeasurement* m : all) {
        direct.push_back(m->directSeconds);
        const std::pair setting(m->method, m->setting);
        if (std::find(settings.begin(), settings.end(), setting) == settings.end()) settings.push_back(setting);
    }
    plot.reference = median(direct);
    plot.referenceLabel = "sum over every texel, no error";
    for (const auto& setting : settings) {
        Measurements list;
        for (const EnvironmentMeasurement* m : all)
            if (m->method == setting.first && m->setting == setting.second) list.push_back(m);
        const auto same = [&](const PlotSeries& s) { return s.name == setting.first; };
        auto at = std::find_if(plot.series.begin(), plot.series.end(), same);
        if (at == plot.series.end()) at = plot.series.insert(at, {setting.first, {}, colorOf(setting.first)});
        at->points.push_back(pointOf(list));
    }
    return plot;
}

/// The maps that more than one method was measured on, so that every point of a plot is the median of the same.
Measurements comparable(const Measurements& all) {
    Measurements out;
    for (const EnvironmentMeasurement* m : all)
        if (std::any_of(all.begin(), all.end(), [m](const EnvironmentMeasurement* o) {
                return o->surrounding == m->surrounding && o->method != m->method;
            }))
            out.push_back(m);
    return out.empty() ? all : out;
}

/// A size's maps, and how many texels a level its errors are of: "128: city, forest (64 texels a level)".
std::string scopeOf(const std::vector<EnvironmentMeasurement>& measurements, int size) {
    std::set<std::string> names;
    int low = 0, high = 0;
    for (const Chain chain : kChains) {
        Measurements list;
        for (const EnvironmentMeasurement& m : measurements)
            if (m.sourceSize == size && m.chain == chain) list.push_back(&m);
        for (const EnvironmentMeasurement* m : comparable(list)) {
            names.insert(escaped(m->surrounding));
            for (const LevelMeasurement& level : m->levels) {
                if (level.error.samples == 0) continue;  // a mirror
                low = low == 0 ? level.error.samples : std::min(low, level.error.samples);
                high = std::max(high, level.error.samples);
            }
        }
    }
    return fmt::format("{}: {} ({} texels a level)", size, fmt::join(names, ", "),
                       low == high ? std::to_string(high) : fmt::format("{} to {}", low, high));
}

std::string measurementTable(const std::vector<EnvironmentMeasurement>& measurements) {
    std::string rows;
    for (const EnvironmentMeasurement& m : measurements) {
        double filtered = 0, largest = 0;
        for (const LevelMeasurement& l : m.levels)
            filtered = std::max(filtered, l.error.filteredRmse), largest = std::max(largest, l.error.max);
        rows += row({escaped(m.surrounding), toString(m.chain), std::to_string(m.sourceSize), escaped(m.method),
                     escaped(m.setting), fmt::format("{:.3g}{}", m.cpuSeconds, m.projected ? " *" : ""),
                     percent(m.worstRmse()), percent(largest), m.projected ? "–" : percent(filtered)});
    }
    return "<details><summary>Every measurement</summary>\n" +
           table({"surrounding", "chain", "source", "method", "setting", "CPU-s", "rmse, worst level", "max",
                  "rmse between texels"},
                 rows) +
           "<p class=\"soft\">* projected from the sampled texels to all.</p></details>\n";
}

}  // namespace

std::string environmentSection(const std::vector<EnvironmentMeasurement>& measurements) {
    if (measurements.empty()) return {};
    std::set<int> sizes;
    std::set<std::pair<int, Chain>> plots;
    for (const EnvironmentMeasurement& m : measurements)
        sizes.insert(m.sourceSize), plots.emplace(m.sourceSize, m.chain);
    std::string scope;
    for (const int size : sizes) scope += (scope.empty() ? "" : "; ") + scopeOf(measurements, size);
    std::string out =
        "<h2>Prefiltered environments</h2>\n<p>Each point is one method at one setting on a whole chain: CPU time of "
        "all threads against the error of its worst level, root mean square over random texels as a share of their "
        "mean, against the sum over every source texel in double precision. Maps of each source's edge: " +
        scope +
        ". Larger sources are measured on fewer maps, at fewer texels and settings, and a GPU that the CPU draws at "
        "coarser ones: a truth or a chain would take minutes. Importance sampling and sums over a reduced source are "
        "plain comparators written here; what they take "
        "for all texels is projected from those that were measured. Ringed: what a tool of the kind does when nothing "
        "is said.</p>\n<div class=\"plots\">\n";
    for (const auto& [size, chain] : plots) {
        Measurements list;
        for (const EnvironmentMeasurement& m : measurements)
            if (m.sourceSize == size && m.chain == chain) list.push_back(&m);
        out += svgPlot(plotOf(comparable(list), chain, size));
    }
    return out + "</div>\n" + measurementTable(measurements);
}

}  // namespace nacre::bench
