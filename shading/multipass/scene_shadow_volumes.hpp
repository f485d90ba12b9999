// The shadow volumes of a scene's objects, stored with them: made again only when the object or the light moved.
#pragma once

#include <map>

#include "core/scene_description.hpp"
#include "shading/multipass/shadow_stencil.hpp"

namespace nacre {

struct ShadowVolumeCounts {
    int made = 0, kept = 0;         ///< volumes, in the last update
    std::size_t bytes = 0;          ///< of all volumes
    std::size_t pointBytes = 0;     ///< of the objects' points, which their volumes share
    std::size_t bytesAPolygon = 0;  ///< what volumes would take with one for each polygon
};

/// A context must be current for all calls. Objects are nodes with a mesh that cast shadows.
class SceneShadowVolumes {
public:
    /// \param scene  outlives this; its meshes don't change
    explicit SceneShadowVolumes(const SceneDescription& scene) : scene_(&scene) {}

    /// \param nodes  nodeTransforms' result \param lights  homogeneous, in the world
    void update(const std::vector<glm::dmat4>& nodes, std::span<const Vec4> lights);
    /// Of one of the lights, as they stand since update().
    std::vector<PlacedShadowVolume> of(std::size_t light) const;
    const ShadowVolumeCounts& counts() const { return counts_; }

private:
    /// One of the scene's meshes, when something needs its volume.
    struct Object {
        explicit Object(const Mesh& mesh) : shape(makeShadowMesh(mesh)), box(boundsOf(mesh)) {
            if (!shape.triangles.empty()) points.emplace(shape);
        }
        ShadowMesh shape;
        Bounds box;
        std::optional<GpuShadowPoints> points;
    };
    struct Stored {
        glm::dmat4 toWorld{0};
        Vec4 light{0};
        std::size_t mostLayers = 0, bytesAPolygon = 0;
        Bounds box;
        std::optional<GpuShadowVolume> volume;
    };
    void store(Stored& stored, const Object& object, const glm::dmat4& toWorld, const Vec4& light);
    const SceneDescription* scene_;
    std::map<int, Object> objects_;                                 ///< by mesh
    std::map<std::pair<std::size_t, std::size_t>, Stored> stored_;  ///< by light and node
    ShadowVolumeCounts counts_;
};

}  // namespace nacre
