#include "shading/scene_bounds.hpp"

#include <algorithm>

namespace nacre {
namespace {

std::vector<SceneBounds> meshBounds(const SceneDescription& scene) {
    std::vector<SceneBounds> out(scene.meshes.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        for (const glm::vec3& p : scene.meshes[i].mesh.positions) out[i].add(p);
    return out;
}

/// Meshes' boxes, or a volume's own.
SceneBounds ownBounds(const SceneDescription& scene, const SceneNode& node, const std::vector<SceneBounds>& meshes) {
    if (node.mesh >= 0) return meshes[static_cast<std::size_t>(node.mesh)];
    SceneBounds out;
    if (node.volume < 0) return out;
    const glm::dmat4 box = volumeToLocal(*scene.volumes[static_cast<std::size_t>(node.volume)].volume);
    out.add(Vec3(box * Vec4(0, 0, 0, 1)));
    out.add(Vec3(box * Vec4(1, 1, 1, 1)));
    return out;
}

void addMoment(SceneBounds& out, const SceneDescription& scene, const std::vector<SceneBounds>& meshes, double time) {
    const std::vector<glm::dmat4> places = nodeTransforms(scene, time);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneBounds own = ownBounds(scene, scene.nodes[i], meshes);
        if (own.empty) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec4 point(corner & 1 ? own.high.x : own.low.x, corner & 2 ? own.high.y : own.low.y,
                             corner & 4 ? own.high.z : own.low.z, 1);
            out.add(Vec3(places[i] * point));
        }
    }
}

}  // namespace

void SceneBounds::add(const Vec3& point) {
    low = empty ? point : glm::min(low, point);
    high = empty ? point : glm::max(high, point);
    empty = false;
}

SceneBounds boundsAt(const SceneDescription& scene, double time) {
    SceneBounds out;
    addMoment(out, scene, meshBounds(scene), time);
    return out;
}

SceneBounds boundsOf(const SceneDescription& scene) {
    constexpr int kMoments = 32;
    constexpr std::size_t kMostMoments = 1024;
    std::vector<double> times = {0};
    if (scene.duration > 0) {
        for (int i = 1; i < kMoments; ++i) times.push_back(scene.duration * i / kMoments);
        for (const SceneTrack& track : scene.tracks) times.insert(times.end(), track.times.begin(), track.times.end());
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
    }
    const std::vector<SceneBounds> meshes = meshBounds(scene);
    SceneBounds out;
    const std::size_t stride = (times.size() + kMostMoments - 1) / kMostMoments;
    for (std::size_t i = 0; i < times.size(); i += stride) addMoment(out, scene, meshes, times[i]);
    return out;
}

Camera cameraSeeing(const SceneBounds& bounds) {
    Camera camera;
    if (bounds.empty) return camera;
    const double radius = bounds.radius() > 0 ? bounds.radius() : 1;
    const double distance = radius / std::sin(camera.fovY / 2);  // of a sphere that touches the picture's edges
    camera.target = bounds.centre();
    camera.eye = camera.target + distance * glm::normalize(Vec3(0.35, 0.4, 1));
    camera.near = camera.far = 0;
    return withDepth(camera, bounds);
}

Camera withDepth(const Camera& camera, const SceneBounds& bounds) {
    const Camera standard;
    double near = standard.near, far = standard.far;
    if (!bounds.empty) {
        const double radius = bounds.radius() > 0 ? bounds.radius() : 1;
        const double distance = glm::length(bounds.centre() - camera.eye);
        far = 1.5 * (distance + radius);
        // Of a scene far larger than what is looked at, not so much of its size that this would be cut.
        const double ahead = glm::length(camera.target - camera.eye);
        near = std::max(std::min(1e-3 * far, 0.02 * ahead), 0.5 * (distance - radius));
    }
    Camera out = camera;
    if (camera.far == 0) out.far = std::max(far, 10 * camera.near);
    if (camera.near == 0) out.near = std::min(near, 0.1 * out.far);
    return out;
}

Camera cameraAt(const Camera& camera, const glm::dmat4& toWorld) {
    Camera out = camera;
    out.eye = Vec3(toWorld * Vec4(camera.eye, 1));
    // As far ahead as it was, so that an orbit about the target keeps its size.
    const Vec3 ahead = camera.target - camera.eye;
    out.target = out.eye + glm::length(ahead) * glm::normalize(Mat3(toWorld) * ahead);
    out.up = glm::normalize(Mat3(toWorld) * camera.up);
    return out;
}

}  // namespace nacre
