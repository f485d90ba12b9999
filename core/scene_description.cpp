#include "core/scene_description.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"

namespace nacre {
namespace {

glm::dquat asQuaternion(const glm::dvec4& v) { return glm::normalize(glm::dquat(v.w, v.x, v.y, v.z)); }

/// The track's value at `time`, which is already within the animation.
glm::dvec4 valueAt(const SceneTrack& track, double time) {
    const auto after = std::upper_bound(track.times.begin(), track.times.end(), time);
    if (after == track.times.begin()) return track.values.front();
    const std::size_t i = static_cast<std::size_t>(after - track.times.begin()) - 1;
    if (after == track.times.end() || track.step) return track.values[i];
    const double s = (time - track.times[i]) / (track.times[i + 1] - track.times[i]);
    if (track.path != SceneTrack::Path::Rotation) return glm::mix(track.values[i], track.values[i + 1], s);
    const glm::dquat q = glm::slerp(asQuaternion(track.values[i]), asQuaternion(track.values[i + 1]), s);
    return {q.x, q.y, q.z, q.w};
}

void apply(SceneNode& node, const SceneTrack& track, double time) {
    const glm::dvec4 value = valueAt(track, time);
    switch (track.path) {
        case SceneTrack::Path::Translation:
            node.translation = value;
            break;
        case SceneTrack::Path::Rotation:
            node.rotation = asQuaternion(value);
            break;
        case SceneTrack::Path::Scale:
            node.scale = value;
            break;
    }
}

glm::dmat4 localMatrix(const SceneNode& node) {
    return glm::translate(glm::dmat4(1), node.translation) * glm::mat4_cast(node.rotation) *
           glm::scale(glm::dmat4(1), node.scale);
}

}  // namespace

std::vector<glm::dmat4> nodeTransforms(const SceneDescription& scene, double time) {
    require(std::isfinite(time), "nodeTransforms: time must be finite");
    if (scene.duration > 0) time -= std::floor(time / scene.duration) * scene.duration;
    std::vector<SceneNode> nodes = scene.nodes;
    for (const SceneTrack& track : scene.tracks) apply(nodes.at(static_cast<std::size_t>(track.node)), track, time);
    std::vector<glm::dmat4> out;
    out.reserve(nodes.size());
    for (const SceneNode& node : nodes) {
        require(node.parent < static_cast<int>(out.size()), "nodeTransforms: a parent must stand before its child");
        const glm::dmat4 local = localMatrix(node);
        out.push_back(node.parent < 0 ? local : out[static_cast<std::size_t>(node.parent)] * local);
    }
    return out;
}

std::vector<Light> lightsInWorld(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes) {
    std::vector<Light> out;
    for (const SceneLight& entry : scene.lights) {
        Light light = entry.light;
        if (entry.node >= 0) {
            const glm::dmat4& toWorld = nodes.at(static_cast<std::size_t>(entry.node));
            light.position = light.directional ? glm::normalize(glm::dmat3(toWorld) * light.position)
                                               : glm::dvec3(toWorld * glm::dvec4(light.position, 1));
            if (light.cone) light.cone->axis = glm::normalize(glm::dmat3(toWorld) * light.cone->axis);
        }
        out.push_back(light);
    }
    return out;
}

Mesh transformed(const Mesh& mesh, const glm::dmat4& toWorld) {
    const glm::dmat3 linear(toWorld), normals = glm::transpose(glm::inverse(linear));
    const bool mirrors = glm::determinant(linear) < 0;
    Mesh out = mesh;
    for (glm::vec3& p : out.positions) p = toWorld * glm::dvec4(p, 1);
    for (glm::vec3& n : out.normals) n = glm::normalize(normals * glm::dvec3(n));
    for (std::size_t i = 0; i < out.tangents.size(); ++i) {
        const glm::dvec3 n = out.normals[i], turned = linear * glm::dvec3(out.tangents[i]);
        out.tangents[i] = glm::vec4(glm::normalize(turned - glm::dot(turned, n) * n),
                                    mirrors ? -out.tangents[i].w : out.tangents[i].w);
    }
    if (mirrors)
        for (glm::uvec3& t : out.triangles) std::swap(t.y, t.z);
    return out;
}

}  // namespace nacre
