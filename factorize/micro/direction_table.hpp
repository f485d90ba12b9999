// A BRDF as a table over all pairs of directions: hemispheres flattened to squares, linear in between.
#pragma once

#include <vector>

#include "core/math.hpp"

namespace nacre {

/// resolution² directions: node (i, j) of a square grid, (0,0) to (1,1) inclusive, goes to the unit disk by Shirley and
/// Chiu's concentric map (continuous, no seam), and radius r to the elevation r · kMaxTableTheta.
inline constexpr double kMaxTableTheta = 87 * kPi / 180;

/// Square coordinates of a direction with z > 0; elevations beyond kMaxTableTheta are held there.
Vec2 directionToSquare(const Vec3& direction);
/// Inverse of directionToSquare up to kMaxTableTheta.
Vec3 squareToDirection(const Vec2& square);

struct DirectionTable {
    int resolution = 0;             ///< ≥ 2
    std::vector<glm::vec3> values;  ///< f [1/sr], [node of wi][node of wo]; resolution⁴
};

/// Direction of node n = j · resolution + i.
Vec3 nodeDirection(int resolution, std::size_t node);

/// f(wi, wo), linear in the four square coordinates; 0 at or below the horizon. Symmetric when the table is.
Rgb evaluate(const DirectionTable& table, const Vec3& wi, const Vec3& wo);

}  // namespace nacre
