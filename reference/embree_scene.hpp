// A mesh that answers rays. Hides Embree's types from everyone else.
#pragma once

#include <cstdint>
#include <memory>

#include "core/scene.hpp"

namespace nacre {

/// Points origin + t·direction, t in [near, far]; direction need not be unit.
struct Ray {
    Vec3 origin, direction;
    double near = 0, far = 0;
};

/// Barycentric weights of the triangle's three corners: 1 − u − v, u, v.
struct RayHit {
    bool found = false;
    std::uint32_t triangle = 0;
    double t = 0, u = 0, v = 0;
};

/// Single precision, watertight at shared edges, both sides of a triangle. Safe to ask from several threads.
class EmbreeScene {
public:
    /// Copies what it needs of the mesh. \throws nacre::Error when Embree fails
    explicit EmbreeScene(const Mesh& mesh);

    RayHit firstHit(const Ray& ray) const;
    bool occluded(const Ray& ray) const;
    double size() const { return size_; }  ///< diagonal of the bounding box [world units], 0 when empty

private:
    std::shared_ptr<void> scene_;
    double size_ = 0;
};

}  // namespace nacre
