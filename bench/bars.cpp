#include "bench/bars.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/error.hpp"

namespace nacre::bench {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A bake of a bar: failed ones have infinite errors.
struct Outcome {
    Material material;
    Measurement m;
    double seconds = kInfinity;  ///< opening included
    double glsl = 0;
    bool usable = false;
};

using Figure = std::function<double(const Outcome&)>;
double l2(const Outcome& o) { return o.usable ? o.m.error.l2Rel : kInfinity; }
double logRms(const Outcome& o) { return o.usable ? o.m.error.logRms : kInfinity; }
double psnr(const Outcome& o) { return o.usable ? o.m.error.spherePsnr : -kInfinity; }
double glsl(const Outcome& o) { return o.usable ? o.glsl : kInfinity; }
double seconds(const Outcome& o) { return o.seconds; }
double nonFinite(const Outcome& o) { return o.usable ? static_cast<double>(o.m.error.nonFinite) : kInfinity; }

class Bench {
public:
    Bench(const std::vector<Material>& materials, GpuLab* lab, const BarOptions& options,
          std::vector<Measurement>* kept)
        : materials_(materials), lab_(lab), options_(options), kept_(kept), pairs_(deviationPairs(20000)) {}

    std::vector<Outcome> bakeAll(const std::function<bool(const Material&)>& chosen, const Setting& setting) {
        std::vector<Outcome> out;
        for (const Material& material : materials_)
            if (chosen(material)) out.push_back(bakeOne(material, setting));
        return out;
    }
    std::vector<Bar> bars;
    std::vector<Outcome> all;  ///< of every bar so far

private:
    Outcome bakeOne(const Material& material, const Setting& setting) {
        report(options_.progress, "bars: " + material.name + ": " + text(setting), 0);
        Outcome out{material, {}};
        try {
            const OpenMaterial opened = open(material);
            if (const auto baked = bake(material, opened, setting, options_.samples)) {
                out.m = baked->measurement;
                out.seconds = opened.openSeconds + out.m.seconds;
                out.usable = true;
                if (lab_) out.glsl = lab_->glslDeviation(baked->brdf, pairs_);
                if (lab_) out.m.cost = lab_->cost(baked->brdf, opened.reflectance);
                if (kept_) kept_->push_back(out.m);
            }
        } catch (const Error& error) {
            report(options_.progress, std::string("failed: ") + error.what(), 0);
        }
        all.push_back(out);
        return out;
    }

    const std::vector<Material>& materials_;
    GpuLab* lab_;
    const BarOptions& options_;
    std::vector<Measurement>* kept_;
    std::vector<DirectionPair> pairs_;
};

/// The outcome furthest from the limit decides.
Bar worstOf(Bar bar, const std::vector<Outcome>& outcomes, const Figure& figure) {
    for (const Outcome& o : outcomes) {
        const double value = figure(o);
        if (bar.measured && (bar.atLeast ? value >= bar.value : value <= bar.value)) continue;
        bar.value = value;
        bar.worst = o.material.name;
        bar.measured = true;
    }
    return bar;
}

Bar medianOf(Bar bar, const std::vector<Outcome>& outcomes, const Figure& figure) {
    std::vector<double> values;
    for (const Outcome& o : outcomes) values.push_back(figure(o));
    bar.measured = !values.empty();
    if (bar.measured) bar.value = median(values);
    bar.worst = fmt::format("median of {}", values.size());
    return bar;
}

bool named(const Material& m, const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), m.name) != names.end();
}

void analyticBars(Bench& bench) {
    const std::vector<std::string> usual = {"Torrance-Sparrow 0.1", "Torrance-Sparrow 0.2", "Torrance-Sparrow 0.35",
                                            "Torrance-Sparrow 0.5"};
    const std::string what = "analytic, Torrance-Sparrow alpha 0.1 to 0.5, half, 64";
    const auto smooth = bench.bakeAll([&](const Material& m) { return named(m, usual); }, {"analytic", 64});
    bench.bars.push_back(worstOf({what, "l2_rel", 0.003}, smooth, l2));
    bench.bars.push_back(worstOf({what, "sphere [dB]", 60, 0, true}, smooth, psnr));
    const std::string sharpWhat = "analytic, Torrance-Sparrow alpha 0.01, half, 128";
    const auto sharp =
        bench.bakeAll([](const Material& m) { return m.name == "Torrance-Sparrow 0.01"; }, {"analytic", 128});
    bench.bars.push_back(worstOf({sharpWhat, "l2_rel", 0.02}, sharp, l2));
    bench.bars.push_back(worstOf({sharpWhat, "non-finite values", 0}, sharp, nonFinite));
}

void measuredBars(Bench& bench) {
    const auto measured = [](const Material& m) { return isMeasured(m.group); };
    const std::string what = "measured isotropic RGB, auto, 2 fetches, 64 KiB";
    const auto large = bench.bakeAll(measured, {.maxBytes = 64 * 1024, .maxFetches = 2});
    bench.bars.push_back(medianOf({what, "l2_rel, median", 0.017}, large, l2));
    bench.bars.push_back(worstOf({what, "l2_rel, worst", 0.08}, large, l2));
    bench.bars.push_back(medianOf({what, "log_rms, median", 0.03}, large, logRms));
    bench.bars.push_back(medianOf({what, "sphere [dB], median", 44, 0, true}, large, psnr));
    bench.bars.push_back(worstOf({what, "sphere [dB], worst", 36, 0, true}, large, psnr));
    std::vector<Outcome> raw;
    for (const Outcome& o : large)
        if (!o.usable || o.m.reciprocityResidual > 0) raw.push_back(o);
    bench.bars.push_back(worstOf({what, "l2_rel / the data's reciprocity residual, worst", 1}, raw,
                                 [](const Outcome& o) { return l2(o) / (o.usable ? o.m.reciprocityResidual : 1); }));
    std::vector<Outcome> tables;
    for (const Outcome& o : large)
        if (o.material.group == Group::MerlTables) tables.push_back(o);
    const auto small = bench.bakeAll(measured, {.maxBytes = 9 * 1024, .maxFetches = 2});
    bench.bars.push_back(
        medianOf({"measured isotropic RGB, auto, 2 fetches, 9 KiB", "l2_rel, median", 0.035}, small, l2));
    bench.bars.push_back(worstOf({"MERL table to two textures, auto", "seconds, worst", 10}, tables, seconds));
}

/// These models are grey, so that 12 KiB a channel are 12 KiB in all.
void anisotropicBars(Bench& bench) {
    const std::vector<std::pair<std::string, double>> rows = {
        {"GGX 0.1/0.4", 0.01}, {"Ward 0.1/0.3", 0.001}, {"Ashikhmin-Shirley 50/500", 0.03}};
    for (const auto& [name, limit] : rows) {
        const auto outcome = bench.bakeAll([&n = name](const Material& m) { return m.name == n; },
                                           {.maxBytes = 12 * 1024, .maxFetches = 3});
        bench.bars.push_back(worstOf({name + ", auto, 3 fetches, 12 KiB a channel", "l2_rel", limit}, outcome, l2));
    }
}

}  // namespace

double median(std::vector<double> values) {
    require(!values.empty(), "median: no values");
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<Bar> measureBars(const std::vector<Material>& materials, GpuLab* lab, const BarOptions& options,
                             std::vector<Measurement>* measurements) {
    Bench bench(materials, lab, options, measurements);
    analyticBars(bench);
    measuredBars(bench);
    anisotropicBars(bench);
    bench.bars.push_back(worstOf({"all of these, half", "GLSL against C++, relative", 2e-3},
                                 lab ? bench.all : std::vector<Outcome>(), glsl));
    return bench.bars;
}

std::string barTable(const std::vector<Bar>& bars) {
    std::string out;
    for (const Bar& bar : bars)
        out += fmt::format("{}  {:<62} {:<30} {:>9.4g}  {} {:g}  {}\n",
                           !bar.measured ? "n/a "
                           : bar.pass()  ? "PASS"
                                         : "MISS",
                           bar.what, bar.figure, bar.value, bar.atLeast ? ">=" : "<=", bar.limit,
                           bar.measured ? "(" + bar.worst + ")" : "(no material at hand)");
    return out;
}

}  // namespace nacre::bench
