#include "bench/environment_bars.hpp"

#include <fmt/format.h>

#include <array>

#include "envmaps/convert.hpp"
#include "envmaps/texel_points.hpp"

namespace nacre::bench {

namespace {

constexpr double kGlossyAlpha = 0.08;  // from here on the GGX chain's tighter limit holds

struct ChainRow {
    Chain chain;
    int size;
    double rmse, cpuSeconds;
};
constexpr std::array<ChainRow, 4> kRows{{{Chain::Phong, 256, 0.003, 0.6},
                                         {Chain::Phong, 512, 0.003, 3},
                                         {Chain::Ggx, 256, 0.005, 1},
                                         {Chain::Diffuse, 256, 0.001, 0.1}}};
constexpr double kSharpGgxRmse = 0.01;

std::string text(const ChainRow& row) {
    const std::vector<PrefilterLevel> levels = chainLevels(row.chain, row.size);
    if (levels.size() == 1) return fmt::format("{}, {} -> {}", toString(row.chain), row.size, levels[0].size);
    return fmt::format("{}, {} -> {}, {} levels", toString(row.chain), row.size, levels.back().size, levels.size());
}

void raise(Bar& bar, double value, const std::string& where) {
    if (bar.measured && value <= bar.value) return;
    bar.value = value;
    bar.worst = where;
    bar.measured = true;
}

std::string lobeText(const Lobe& lobe) {
    if (lobe.kind == LobeKind::Phong) return fmt::format("exponent {:.4g}", lobe.exponent);
    return usesAlpha(lobe.kind) ? fmt::format("alpha {:.3g}", lobe.alpha) : toString(lobe.kind);
}

/// Real Y_l0, Re and Im of Y_l1, Y_l2 up to degree 2 as polynomials (Ramamoorthi & Hanrahan 2001, eq. 3), with the
/// phase of Harmonics.
std::array<double, 9> secondOrder(const Vec3& d) {
    const double k0 = 0.5 / std::sqrt(kPi), k10 = std::sqrt(3 / (4 * kPi)), k11 = -std::sqrt(3 / (8 * kPi));
    const double k20 = 0.25 * std::sqrt(5 / kPi), k21 = -std::sqrt(15 / (8 * kPi)),
                 k22 = 0.25 * std::sqrt(15 / (2 * kPi));
    return {k0,
            k10 * d.z,
            k11 * d.x,
            k11 * d.y,
            k20 * (3 * d.z * d.z - 1),
            k21 * d.x * d.z,
            k21 * d.y * d.z,
            k22 * (d.x * d.x - d.y * d.y),
            k22 * 2 * d.x * d.y};
}

/// Largest difference of a coefficient from the sum in double, relative to the largest coefficient.
double harmonicsDeviation(const EnvMap& source) {
    const std::vector<SpherePoint> points = texelPoints(source);
    std::array<Rgb, 9> sums;
    sums.fill(Rgb(0));
    for (const SpherePoint& p : points) {
        const std::array<double, 9> y = secondOrder(p.direction);
        for (std::size_t i = 0; i < y.size(); ++i) sums[i] += y[i] * Rgb(p.weight);
    }
    const Harmonics found = analyseHarmonics(points, 2);
    std::size_t i = 0;
    double worst = 0, largest = 0;
    const auto compare = [&](const Vec4& value, double sign) {
        worst = std::max(worst, maxComponent(glm::abs(sign * Rgb(value) - sums[i])));
        largest = std::max(largest, maxComponent(glm::abs(sums[i++])));
    };
    for (int l = 0; l <= 2; ++l)
        for (int m = 0; m <= l; ++m) {
            compare(found.at(l, m).re, 1);
            if (m > 0) compare(found.at(l, m).im, -1);  // a_lm has Y's conjugate
        }
    return worst / largest;
}

/// There and back between every two layouts: largest change of Σ L dω on the way, relative.
double energyDeviation(const EnvMap& latLong) {
    constexpr std::array kLayouts = {EnvLayout::LatLong, EnvLayout::Cube, EnvLayout::DualParaboloid,
                                     EnvLayout::Octahedral};
    constexpr int kSize = 64;
    double worst = 0;
    for (const EnvLayout from : kLayouts) {
        const EnvMap there = convertEnv(latLong, from, kSize);
        const Rgb before = envEnergy(there);
        for (const EnvLayout to : kLayouts)
            for (const Rgb& after : {envEnergy(convertEnv(there, to, kSize)),
                                     envEnergy(convertEnv(convertEnv(there, to, kSize), from, kSize))})
                worst = std::max(worst, maxComponent(glm::abs(after - before)) / maxComponent(before));
    }
    return worst;
}

/// Values of all chains at 128 that aren't the same bits with 1 thread and with 7.
double threadDifferences(const BenchSurrounding& surrounding) {
    std::size_t differences = 0;
    const EnvMap source = asCube(surrounding, 128);
    for (const Chain chain : kChains) {
        PrefilterOptions one, seven;
        one.threads = 1, seven.threads = 7;
        const std::vector<PrefilterLevel> levels = chainLevels(chain, 128);
        const Prefiltered a = prefilter(source, levels, one), b = prefilter(source, levels, seven);
        for (std::size_t i = 0; i < levels.size(); ++i)
            for (std::size_t k = 0; k < a.levels[i].image.data().size(); ++k)
                differences += a.levels[i].image.data()[k] != b.levels[i].image.data()[k];
    }
    return static_cast<double>(differences);
}

}  // namespace

std::vector<Bar> chainBars(const std::vector<EnvironmentMeasurement>& measurements) {
    std::vector<Bar> out;
    for (const ChainRow& row : kRows) {
        const bool split = row.chain == Chain::Ggx;
        Bar error{text(row), split ? "rmse, worst level of alpha >= 0.08" : "rmse, worst level", row.rmse};
        Bar sharp{text(row), "rmse, alpha 0.018", kSharpGgxRmse}, seconds{text(row), "CPU-seconds", row.cpuSeconds};
        for (const EnvironmentMeasurement& m : measurements) {
            if (m.method != "nacre" || !m.usual || m.chain != row.chain || m.sourceSize != row.size) continue;
            raise(seconds, m.cpuSeconds, m.surrounding);
            for (const LevelMeasurement& l : m.levels) {
                if (l.level.lobe.kind == LobeKind::Mirror) continue;
                const bool isSharp = split && l.level.lobe.alpha < kGlossyAlpha;
                raise(isSharp ? sharp : error, l.error.rmse,
                      fmt::format("{}, {}, {} samples", m.surrounding, lobeText(l.level.lobe), l.error.samples));
            }
        }
        out.push_back(error);
        if (split) out.push_back(sharp);
        out.push_back(seconds);
    }
    return out;
}

std::vector<Bar> measureEnvironmentBars(const std::vector<BenchSurrounding>& surroundings,
                                        const EnvironmentBarOptions& options,
                                        std::vector<EnvironmentMeasurement>* measurements) {
    std::vector<EnvironmentMeasurement> measured;
    Bar harmonics{"harmonics to order 2, cube 256", "coefficient against the sum in double, relative", 1e-5};
    Bar energy{"any layout to any layout and back, 64", "energy, relative change", 1e-4};
    Bar threads{"all chains at 128, 1 thread against 7", "values with other bits", 0};
    for (const BenchSurrounding& surrounding : surroundings) {
        for (const ChainRow& row : kRows) {
            if (row.size > 256 && !options.large) continue;
            const ChainTruth truth = drawChainTruth(surrounding, row.chain, row.size,
                                                    affordableSamples(options.samples, row.size), options.progress);
            measured.push_back(measurePrefilter(truth, PrefilterOptions{}.tolerance, 3));
        }
        report(options.progress, "harmonics, conversions, threads: " + surrounding.name, 0);
        raise(harmonics, harmonicsDeviation(asCube(surrounding, 256)), surrounding.name);
        raise(energy, energyDeviation(surrounding.map), surrounding.name);
        raise(threads, threadDifferences(surrounding), surrounding.name);
    }
    std::vector<Bar> out = chainBars(measured);
    out.insert(out.end(), {harmonics, energy, threads});
    if (measurements) measurements->insert(measurements->end(), measured.begin(), measured.end());
    return out;
}

}  // namespace nacre::bench
