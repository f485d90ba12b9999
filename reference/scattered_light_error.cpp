#include "reference/scattered_light_error.hpp"

#include <limits>
#include <random>

#include "core/error.hpp"

namespace nacre {

ReliefLightSamples drawReliefLightSamples(const HeightMap& map, const ReliefLightOptions& options, int count,
                                          std::uint64_t seed) {
    validateHeightMap(map);
    require(count >= 1, "drawReliefLightSamples: expected count >= 1");
    std::vector<glm::ivec2> solid;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x)
            if (!std::isnan(map.heights.at(x, y, 0))) solid.emplace_back(x, y);
    require(!solid.empty(), "drawReliefLightSamples: expected a relief, found holes alone");
    std::mt19937_64 random(seed);
    ReliefLightSamples out;
    for (int i = 0; i < count; ++i) out.texels.push_back(solid[random() % solid.size()]);
    out.truth = traceReliefLight(map, out.texels, options);
    return out;
}

ScatteredLightError measureScatteredLight(const ReliefLightSamples& samples, const ScatteredLight& light) {
    double apart = 0, apartTotal = 0, own = 0, ownTotal = 0, noise = 0, found = 0, sum = 0, sumTotal = 0;
    for (std::size_t i = 0; i < samples.texels.size(); ++i) {
        const auto [x, y] = std::pair(samples.texels[i].x, samples.texels[i].y);
        require(x >= 0 && y >= 0 && x < light.indirect.width() && y < light.indirect.height(),
                "measureScatteredLight: expected light of the relief's size");
        const TexelLight& truth = samples.truth[i];
        const Rgb a = light.sky.rgb(x, y) + light.indirect.rgb(x, y), b = truth.sky + truth.indirect;
        const Rgb total = a + light.direct.rgb(x, y) - truth.total();
        apart += glm::dot(a - b, a - b), own += glm::dot(b, b);
        apartTotal += glm::dot(total, total), ownTotal += glm::dot(truth.total(), truth.total());
        noise += glm::dot(truth.standardError, truth.standardError);
        found += a.r + a.g + a.b, sum += b.r + b.g + b.b;
        sumTotal += truth.total().r + truth.total().g + truth.total().b;
    }
    const auto relative = [](double part, double whole) {
        return part == 0 ? 0 : whole == 0 ? std::numeric_limits<double>::infinity() : part / whole;
    };
    ScatteredLightError out;
    out.indirect = std::sqrt(relative(apart, own));
    out.total = std::sqrt(relative(apartTotal, ownTotal));
    out.noise = std::sqrt(relative(noise, own));
    out.bias = relative(found - sum, sum);
    out.share = relative(sum, sumTotal);
    out.samples = static_cast<int>(samples.texels.size());
    return out;
}

}  // namespace nacre
