// How much room a scene takes, and a camera that sees it.
#pragma once

#include "core/scene_description.hpp"

namespace nacre {

/// A box about everything that has a mesh or volume, at one moment or over the whole animation.
struct SceneBounds {
    Vec3 low{0}, high{0};
    bool empty = true;  ///< no node has either

    Vec3 centre() const { return 0.5 * (low + high); }
    double radius() const { return 0.5 * glm::length(high - low); }
    void add(const Vec3& point);
};

/// A box about the meshes' and volumes' boxes where the nodes place them at `time` [s]: never too small.
SceneBounds boundsAt(const SceneDescription& scene, double time);
/// The same over the animation, at 32 moments and every key frame (1024 at most).
SceneBounds boundsOf(const SceneDescription& scene);

/// Stands in front (+z), a little above and to the right, and sees all of `bounds`; the default camera when empty.
Camera cameraSeeing(const SceneBounds& bounds);
/// The camera with those of near and far that are 0 fitted about `bounds`, with room to move: near is far / 1000 or
/// more, but no more than a fiftieth of the way to the target unless nothing is that near; the default camera's where
/// bounds are empty.
Camera withDepth(const Camera& camera, const SceneBounds& bounds);

/// A camera of a node in the world: turned and moved, not scaled.
Camera cameraAt(const Camera& camera, const glm::dmat4& toWorld);

}  // namespace nacre
