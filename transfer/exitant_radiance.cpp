#include "transfer/exitant_radiance.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {

/// Where the x, y and z axes go (Rodrigues).
static Receiver turnedFrame(const Vec3& axis, double angle) {
    const Vec3 k = glm::normalize(axis);
    const auto turned = [&](const Vec3& v) {
        return glm::vec3(v * std::cos(angle) + glm::cross(k, v) * std::sin(angle) +
                         k * glm::dot(k, v) * (1 - std::cos(angle)));
    };
    return {glm::vec3(0), turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

LightCoefficients turnedLight(const HarmonicRotation& rotation, const LightCoefficients& light, const Vec3& axis,
                              double angle) {
    const std::size_t count = light.size();
    require(count == static_cast<std::size_t>((rotation.order() + 1) * (rotation.order() + 1)),
            "turned light: expected as many coefficients as the rotation has");
    require(isFinite(axis) && glm::length(axis) > 0 && std::isfinite(angle),
            "turned light: expected a finite angle and an axis other than 0");
    std::vector<float> before(kLanes * count, 0.0f), after(3 * count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c) before[i * kLanes + c] = static_cast<float>(light[i][static_cast<int>(c)]);
    const std::vector<Receiver> frames(3, turnedFrame(axis, angle));  // one a colour
    rotation.turn(frames.data(), 3, before.data(), after.data());
    LightCoefficients out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = {after[i], after[count + i], after[2 * count + i]};
    return out;
}

LightCoefficients blendedLights(std::span<const LightCoefficients> lights, std::span<const double> weights) {
    require(!lights.empty() && lights.size() == weights.size(), "blended lights: expected one weight a light");
    LightCoefficients out(lights[0].size(), Rgb(0));
    for (std::size_t k = 0; k < lights.size(); ++k) {
        require(lights[k].size() == out.size(), "blended lights: expected lights of one order");
        require(std::isfinite(weights[k]), "blended lights: expected finite weights");
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += weights[k] * lights[k][i];
    }
    return out;
}

std::vector<glm::vec3> exitantRadiance(std::span<const float> transfer, const LightCoefficients& light,
                                       const Rgb& albedo, unsigned threads) {
    require(!light.empty() && transfer.size() % light.size() == 0,
            "exitant radiance: expected as many coefficients a vertex as the light has");
    std::vector<glm::vec3> out(transfer.size() / light.size());
    constexpr std::size_t kChunk = 1024;
    parallelFor((out.size() + kChunk - 1) / kChunk, threads, [&](std::size_t chunk) {
        for (std::size_t v = chunk * kChunk; v < std::min(out.size(), (chunk + 1) * kChunk); ++v) {
            Rgb sum(0);
            for (std::size_t i = 0; i < light.size(); ++i)
                sum += static_cast<double>(transfer[v * light.size() + i]) * light[i];
            out[v] = albedo * sum;
        }
    });
    return out;
}

}  // namespace nacre
