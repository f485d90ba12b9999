// Point lights that stand for what surfaces reflect once (HYBRID section 3). No OpenGL in here.
#pragma once

#include <span>
#include <vector>

#include "shading/hybrid/scene_elements.hpp"

namespace nacre {

/// Gives radiant intensity power/π · cosθ about its normal. Near by it is the rectangle place ± u ± v, whose area is
/// that of the surface it stands for; from `position`, a point of that surface, it sees what it lights.
struct VirtualPointLight {
    Vec3 position{0}, normal{0};
    Vec3 place{0}, u{0}, v{0};  ///< u, v and the normal are a right-handed cross of right angles
    Rgb power{0};               ///< [W]
    double area() const { return 4 * glm::length(u) * glm::length(v); }
};

/// How a light looks near by. Point: the paper's, with a singularity. Disk: its area facing the point, which bounds it:
/// 1/r² becomes 1/(r² + area/π), the form factor of a disk seen on its axis. Rectangle: Lambert's form factor of the
/// rectangle within four of its half diagonals, and the disk beyond. What is below the receiver's horizon isn't
/// clipped.
enum class NearLight { Point, Disk, Rectangle };

/// Strongest: the paper's. The elements that reflect most, by a partial sort; the others' power is left out.
/// Grouped: all elements that reflect, in groups near each other in place and direction; none is left out.
enum class VirtualLightChoice { Strongest, Grouped };

struct VirtualLights {
    std::vector<VirtualPointLight> lights;
    double leftOut = 0;  ///< share of the power that is in none of them
};

/// Irradiance [1/m²] that a light of intensity cosθ gives a place with normal n: x, and y as a point: cosθ cosθ'/r². 0
/// behind either. Twin: nacre_virtual_light.
Vec2 virtualLightGeometry(const VirtualPointLight& light, const Vec3& place, const Vec3& n, NearLight near);

/// At most `count` lights. Grouped: starting with one group, the one whose spread (power · variance of centres and of
/// normals times a quarter of the scene's size) is largest is cut at its mean across its longest axis, until there are
/// enough; a light's position is in the element nearest to its group's mean, so that it is on a surface. Rectangles
/// have the mean and variances of the group's area along an axis of the world and across it. \param power  of each
/// element. \throws std::invalid_argument for another number of powers, count < 1
VirtualLights chooseVirtualLights(const SceneElements& elements, std::span<const Rgb> power, int count,
                                  VirtualLightChoice choice);

}  // namespace nacre
