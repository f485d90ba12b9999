#include "core/light_area.hpp"

#include "core/error.hpp"

namespace nacre {

std::vector<std::optional<LightArea>> areasInWorld(const SceneDescription& scene,
                                                   const std::vector<glm::dmat4>& nodes) {
    std::vector<std::optional<LightArea>> out;
    for (const SceneLight& light : scene.lights) {
        out.push_back(light.area);
        if (!light.area || light.node < 0) continue;
        const Mat3 linear(nodes.at(static_cast<std::size_t>(light.node)));
        out.back() = LightArea{linear * light.area->u, linear * light.area->v};
    }
    return out;
}

Light pointOfArea(const Light& light, const LightArea& area, const Vec2& square) {
    Light out = light;
    out.position += (2 * square.x - 1) * area.u + (2 * square.y - 1) * area.v;
    return out;
}

std::vector<Light> pointsOfArea(const Light& light, const LightArea& area, int count) {
    require(count >= 1, "pointsOfArea: expected at least one point");
    require(!light.directional, "pointsOfArea: a directional light has no area");
    std::vector<Light> out;
    for (int i = 0; i < count; ++i) {
        // Roberts' R2 from the middle on; each point but an odd one is followed by its mirror image.
        const int k = i == count - 1 && count % 2 == 1 ? 0 : i / 2 + 1;
        const Vec2 p(0.5 + 0.7548776662466927 * k, 0.5 + 0.5698402909980532 * k);
        const Vec2 in = p - glm::floor(p);
        out.push_back(pointOfArea(light, area, k > 0 && i % 2 == 1 ? Vec2(1) - in : in));
        out.back().color /= double(count);
    }
    return out;
}

}  // namespace nacre
