// The shadow volumes of a scene's objects, stored with them: made again only when the object or the light moved.
#pragma once

#include <map>
#include <tuple>

#include "core/scene_description.hpp"
#include "shading/multipass/shadow_source.hpp"
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

    /// Sources of one name share the volumes of objects that no plane cuts. \param nodes  nodeTransforms' result
    void update(const std::vector<glm::dmat4>& nodes, std::span<const ShadowSource> sources);
    /// Of one of the sources, as they stand since update().
    const std::vector<PlacedShadowVolume>& of(std::size_t source) const { return placed_.at(source); }
    /// The light volume that a face's node sends on from a source: one shadow volume of the face's own, if any.
    /// \param seen  the light and where the volume is seen
    std::optional<PlacedShadowVolume> ofFace(std::size_t node, const ShadowSource& seen);
    /// What neither update() nor ofFace() since then asked for.
    void forgetUnused();
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
        std::vector<Plane> cuts;  ///< in the world
        std::vector<Plane> cutsInMesh;
        std::size_t mostLayers = 0, bytesAPolygon = 0;
        bool used = false;                      ///< in this update
        std::optional<GpuShadowPoints> points;  ///< of a cut mesh
        std::optional<GpuShadowVolume> volume;
    };
    /// By source, node and cutting faces.
    using Key = std::tuple<std::vector<int>, std::size_t, std::vector<std::size_t>>;
    const Object& objectOf(std::size_t node);
    Stored& stored(const Key& key, const Object& object, const glm::dmat4& toWorld, const Vec4& light,
                   const std::vector<Plane>& cuts);
    static PlacedShadowVolume placed(const Stored& stored, const Object& object, const glm::dmat4& toLast);
    const SceneDescription* scene_;
    std::map<int, Object> objects_;  ///< by mesh
    std::map<Key, Stored> stored_;
    std::vector<glm::dmat4> nodes_;
    std::vector<std::vector<PlacedShadowVolume>> placed_;  ///< a source
    ShadowVolumeCounts counts_;
};

}  // namespace nacre
