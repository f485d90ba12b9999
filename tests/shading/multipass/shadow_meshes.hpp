// Meshes that shadow volumes find hard.
#pragma once

#include <string>
#include <vector>

#include "core/scene.hpp"

namespace nacre::test {

/// b's triangles after a's.
Mesh together(Mesh a, const Mesh& b);

/// Flat normals, one vertex a corner. \param corners  three a triangle
Mesh fromCorners(const std::vector<Vec3>& corners);

Mesh box(const Vec3& low, const Vec3& high);
/// Every triangle turned over, normals too.
Mesh insideOut(Mesh mesh);
/// Three squares that share one edge, the y axis.
Mesh fan();
/// A band with one side.
Mesh moebius();

struct NamedMesh {
    std::string name;
    Mesh mesh;
    bool solid = false;
};
/// About the origin, within 1.2 of it.
std::vector<NamedMesh> hardMeshes();

}  // namespace nacre::test
