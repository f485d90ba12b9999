// A camera as rays, where OpenGL has its pixel centres (Camera::projection).
#pragma once

#include <vector>

#include "core/scene.hpp"
#include "reference/embree_scene.hpp"

namespace nacre {

class CameraRays {
public:
    /// \param width, height  [pixels]; supersample: n × n rays a pixel on a regular grid
    CameraRays(const Camera& camera, int width, int height, int supersample);
    /// \param points  of each pixel, from its upper left corner to (1, 1)
    CameraRays(const Camera& camera, int width, int height, std::vector<Vec2> points);

    int samples() const { return static_cast<int>(points_.size()); }
    /// Ray k of pixel (x, y), row 0 on top: origin + t·direction with t the depth along the viewing axis, between the
    /// near and far plane.
    Ray at(int x, int y, int k) const;

private:
    glm::dmat4 toWorld_;
    Vec2 halfExtent_;  ///< perspective: at depth 1; orthographic: at any depth
    int width_, height_;
    std::vector<Vec2> points_;
    bool orthographic_;
    double near_, far_;
};

}  // namespace nacre
