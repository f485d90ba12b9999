// A scene that answers rays: its meshes as one and its volumes.
#pragma once

#include <optional>
#include <vector>

#include "core/scene_description.hpp"
#include "reference/volume_field.hpp"

namespace nacre {

class SceneRays {
public:
    /// The scene outlives this. \param nodes  nodeTransforms' result
    /// \throws std::invalid_argument: a mesh without an attribute, positions that aren't finite, checkVolume's
    SceneRays(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes);

    struct Hit {
        SurfacePoint s;
        std::size_t node = 0;
        Vec3 plane{0};  ///< unit normal of the triangle, to where it is counter-clockwise; of volumes 0
    };
    /// \param toEye  unit, against the ray
    std::optional<Hit> firstHit(const Ray& ray, const Vec3& toEye) const;
    /// Whether something that casts shadows, or anything, is on the way from a surface in this direction (unit).
    /// \param distance  to the light; infinite for directional ones
    bool shadowed(const Vec3& position, const Vec3& direction, double distance) const;
    bool blocked(const Vec3& position, const Vec3& direction) const;
    /// Past the triangle that a ray starts from: positions are single precision.
    double skip() const { return 1e-5 * all_.size(); }

private:
    /// Meshes in the world as one, and which node a triangle belongs to.
    struct World {
        World(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, bool castersAlone);
        std::size_t nodeOf(std::uint32_t triangle) const;
        Vec3 normalOf(std::uint32_t triangle) const;
        Mesh mesh;
        std::vector<std::size_t> firstTriangle, nodes;
    };
    struct PlacedVolume {
        std::size_t node;
        bool casts;
        VolumeField field;
    };
    bool insideVolume(const Vec3& position, const Vec3& direction, double distance, bool castersAlone) const;

    World world_;
    EmbreeScene all_, casters_;
    std::vector<PlacedVolume> volumes_;
};

}  // namespace nacre
