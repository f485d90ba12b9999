#include "reference/scene_components.hpp"

#include "core/parallel.hpp"
#include "reference/camera_rays.hpp"
#include "reference/scene_rays.hpp"

namespace nacre {
namespace {

Image tags(const SceneDescription& scene, const Camera& camera, const SceneTraceOptions& options) {
    const SceneRays surfaces(scene, nodeTransforms(scene, options.time));
    const CameraRays rays = options.points.empty()
                                ? CameraRays(camera, options.width, options.height, options.supersample)
                                : CameraRays(camera, options.width, options.height, options.points);
    Image out(options.width, options.height, 1);
    parallelFor(static_cast<std::size_t>(options.height), options.threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < options.width; ++x) {
            int specular = 0;
            for (int k = 0; k < rays.samples(); ++k) {
                const Ray ray = rays.at(x, y, k);
                const auto hit = surfaces.firstHit(ray, -glm::normalize(ray.direction));
                if (!hit) continue;
                const int material = scene.nodes[hit->node].material;
                specular += scene.materials[static_cast<std::size_t>(material)].specular.has_value();
            }
            out.at(x, y, 0) = static_cast<float>(specular) / static_cast<float>(rays.samples());
        }
    });
    return out;
}

}  // namespace

SceneComponents traceComponents(const SceneDescription& scene, const Camera& camera, const SceneTruths& truths,
                                const SceneTraceOptions& options, bool bounce) {
    SceneParts direct, indirect, all;
    direct.firstSurface = indirect.firstSurface = SceneParts::FirstSurface::Other;
    SceneParts unshadowed = direct;
    unshadowed.shadows = false;
    indirect.lamps = indirect.ambient = indirect.surrounding = indirect.sky = false;
    indirect.interreflection = all.interreflection = bounce;
    indirect.bounces = all.bounces = 1;
    SceneParts traced = all;
    traced.firstSurface = SceneParts::FirstSurface::Specular;
    std::vector<Image> pictures =
        traceScene(scene, camera, truths, {direct, unshadowed, indirect, traced, all}, options);
    return {std::move(pictures[0]), std::move(pictures[1]), std::move(pictures[2]),
            std::move(pictures[3]), std::move(pictures[4]), tags(scene, camera, options)};
}

}  // namespace nacre
