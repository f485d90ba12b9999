#include "shading/hybrid/level_pass.hpp"

namespace nacre {

GlName LevelPass::draw(int width, int height, const Camera& camera, double time, const SampledShadowOptions& options) {
    if (scene_.lights.empty()) return 0;
    if (!geometry_ || geometry_->width() != width || geometry_->height() != height) geometry_.emplace(width, height);
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene_, time);
    const std::vector<Rgb> black(scene_.materials.size(), Rgb(0));
    geometry_->draw(loader_, scene_, nodes, black, meshes_, camera);
    return shadows_.draw(*geometry_, camera, nodes, options);
}

}  // namespace nacre
