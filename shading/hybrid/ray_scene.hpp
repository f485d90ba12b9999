// A scene's meshes that answer rays on the CPU while the pipeline draws (HYBRID section 4.3). Hides Embree's types.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/scene_description.hpp"

namespace nacre {

struct RaySceneHit {
    Vec3 place;
    Vec3 normal;  ///< unit, interpolated
    Vec3 face;    ///< unit, of the triangle, to where it is counter-clockwise
    std::size_t node = 0;
};

/// Single precision, both sides of a triangle. Safe to ask from several threads.
class RayScene {
public:
    /// \param nodes  nodeTransforms' result \throws nacre::Error when Embree fails
    RayScene(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes);

    /// \param direction  unit
    std::optional<RaySceneHit> firstHit(const Vec3& from, const Vec3& direction) const;
    /// Whether something is between two points. \param castersAlone  of nodes that cast shadows
    bool blocked(const Vec3& from, const Vec3& to, bool castersAlone) const;
    double skip() const { return skip_; }  ///< what rays pass over where they start [world units]

private:
    struct Part {
        Mesh mesh;  ///< in the world
        std::size_t node;
    };
    std::vector<Part> parts_;  ///< by Embree's number
    double skip_ = 0;          ///< past the surface that a ray starts from
    std::shared_ptr<void> all_, casters_;
};

}  // namespace nacre
