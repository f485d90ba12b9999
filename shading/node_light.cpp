#include "shading/node_light.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "shading/mean_light.hpp"
#include "shading/scene_shadow_maps.hpp"

namespace nacre {

/// Made again when the light has turned by this much [rad], far below what is seen.
static constexpr double kTurned = 2e-3;

void NodeLight::update(ProgramLoader& loader, const NodeLightInput& input) {
    const SceneRelief& relief = input.relief;
    const auto index = static_cast<std::size_t>(relief.asset);
    const bool same = gpu_ && asset_ == relief.asset && version_ == input.assets.version(index) &&
                      bounces_ == relief.bounces && paths_ == relief.paths && albedo_ == relief.albedo;
    if (!same) {
        const BumpMaps maps = input.assets.readBump(index);
        if (!maps.heights || !maps.scatter)
            throw Error(fmt::format("{}: expected heights and a scatter map, found them gone", input.file.string()));
        GpuReliefLightOptions options;
        options.albedo = relief.albedo;
        options.bounces = relief.bounces;
        options.paths = relief.paths;
        gpu_ = std::make_unique<GpuReliefLight>(loader, HeightMap{*maps.heights, maps.wrap}, *maps.scatter, options);
        asset_ = relief.asset;
        version_ = input.assets.version(index);
        bounces_ = relief.bounces;
        paths_ = relief.paths;
        albedo_ = relief.albedo;
        direction_ = Vec3(0);
    } else if (toWorld_ == input.toWorld && sameLight(light_, input.light)) {
        return;
    }
    const Vec3 direction = meanLightDirection(input.mesh, input.toWorld, input.light);
    toWorld_ = input.toWorld;
    light_ = input.light;
    if (glm::length(direction - direction_) < kTurned) return;
    gpu_->update({.light = direction});
    direction_ = direction;
}

}  // namespace nacre
