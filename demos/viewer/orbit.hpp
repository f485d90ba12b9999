// Moves of the viewer's camera. Mouse moves are in pixels, x to the right, y down, of a picture `height` pixels high.
#pragma once

#include <string>

#include "core/scene.hpp"

namespace nacre {

/// Half a turn for a drag over the picture's height: about `up` through the target, and over it, up to 0.5 degrees from
/// the poles. Eye and target keep their distance. A drag to the right turns the scene to the right.
Camera orbited(const Camera& camera, Vec2 pixels, int height);

/// Moves eye and target across the view, so that what is as deep as the target follows the mouse.
Camera panned(const Camera& camera, Vec2 pixels, int height);

/// Nearer to the target by 10 % a step; steps < 0 go away. Orthographic cameras see a smaller extent instead.
Camera zoomed(const Camera& camera, double steps);

/// A pixel's size in world units at `depth` [world units, > 0] before the eye.
double pixelSize(const Camera& camera, double depth, int height);

/// Where a point of the world is in a picture [pixels from its top left corner]; z: depth before the eye.
Vec3 inPicture(const Camera& camera, const Vec3& point, Vec2 size);

/// The camera as the section of a scene file: "camera": {…}, that reads back to the same camera.
std::string cameraText(const Camera& camera);

}  // namespace nacre
