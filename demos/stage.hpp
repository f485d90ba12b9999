// What stands before the camera: mesh, camera, lights. Rasteriser and ray tracer draw the same Stage.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene.hpp"

namespace nacre {

struct Stage {
    Mesh mesh;
    Camera camera;
    std::vector<Light> lights;
    double aspect = 1;  ///< width / height of its picture
    std::string words;  ///< mesh, camera and lights for a reader
    std::string note;   ///< not empty when something else stands in for what was asked
};

/// The shapes of HSE figures 2 to 4. Each has its own camera and lights.
enum class GrooveDirection { Circular, Radial };

/// Figure 2: torus of 200 × 200 quadrilaterals, one directional light, orthographic camera, so that texture matrices
/// apply too.
Stage torusStage();

/// Figure 3: a disk and a sphere side by side under one near point light, seen in perspective.
Stage diskAndSphereStage(GrooveDirection grooves);

/// Figure 4: the teapot, seen from azimuth `azimuthDeg` about its axis (0 = the side, spout to the right; positive
/// turns the spout towards the viewer). The tangent is the handle-to-spout direction, projected into the surface.
Stage teapotStage(double azimuthDeg);

/// Scanned meshes by file name without `.off`; \see demos/fetch.sh. When the file isn't in `folder`, the teapot.
/// \throws std::invalid_argument for other names (lists them); nacre::Error when the file is there but broken
Stage scanStage(const std::string& name, const std::filesystem::path& folder);

/// b's triangles after a's.
Mesh joined(Mesh a, const Mesh& b);

/// By name: torus, disk-sphere-circular, disk-sphere-radial, teapot-left, teapot-right, scan:NAME.
/// \throws std::invalid_argument for other names (lists them), and as scanStage
Stage openStage(const std::string& name, const std::filesystem::path& meshFolder);

/// Unit direction towards a light: azimuth from +z towards +x, elevation above the plane y = 0. [degrees]
Vec3 directionFromDeg(double azimuthDeg, double elevationDeg);

}  // namespace nacre
