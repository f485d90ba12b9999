// Rays over a relief, patch by patch in double precision: the truth of horizons, shadows and scatter maps. Slow and
// obvious: each patch of the line solved in closed form, one ray at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bump/height_map.hpp"

namespace nacre {

/// One axis of patches: patch i lies between the texel centres i and i + 1, any i. Beyond the borders patches repeat
/// (mirrored: with twice the period) or, clamped, all are the one between the border texel and itself.
struct ReliefAxis {
    ReliefAxis(int texels, Wrap wrap);
    int stored(std::int64_t patch) const;  ///< which of the `patches` stored ones is patch i

    int patches = 0;
    int texels = 0;
    Wrap wrap = Wrap::Repeat;
};

/// The surface of bump/height_map.hpp, unrolled so that a patch's corners are neighbours in memory. Made of a map
/// wherever one is passed; who shoots many rays makes it once, as that costs O(texels).
struct Relief {
    Relief(const HeightMap& map);  // implicit: the functions below take maps

    double heightAt(const Vec2& p) const;  ///< nacre::heightAt

    ReliefAxis columns, rows;
    std::vector<float> corners;  ///< (columns.patches + 1) × (rows.patches + 1), row by row
    double high = 0;             ///< of all heights
    double reach = 0;            ///< reachOf(map)
};

/// Tangent of the horizon's elevation at a point of the surface: max(0, sup over the line towards `azimuth` of (height
/// − own height) / distance), up to the reach; as distance → 0 that is the own patch's slope. Exact but for rounding.
/// \param from     point in the plane [texels]; where there is no surface the answer is 0
/// \param azimuth  [rad], from x to y
/// \throws std::invalid_argument unless the numbers are finite
/// Cost: patches on the line until (highest − own height) / distance is no more than the slope found.
double horizonSlope(const Relief& relief, const Vec2& from, double azimuth);

/// Whether the light at infinity in direction `light` (any length > 0) is seen from a point of the surface: not below
/// the plane, nor below the horizon. Grazing, to 1e-12 of the slope, is lit; so are holes.
bool isLit(const Relief& relief, const Vec2& from, const Vec3& light);

/// Where a ray meets the surface.
struct ReliefHit {
    double planeDistance = 0, rayDistance = 0;  ///< [texels] from the start, along the plane and along the ray
    Vec3 point{0};                              ///< [texels], on the surface; not wrapped
    Vec3 normal{0, 0, 1};                       ///< of the patch
};

/// First point at which the ray is below the surface: it goes through a patch, or comes out of a hole lower than the
/// border of the patch beside it (as for horizons: patches block all below them; the point then lies above the ray).
/// Touching is no hit. A start on the surface (or less than rounding beside it) with a direction below its patch is one
/// at distance 0, and so is a start below the surface. On the border of patches the direction tells which is entered;
/// along a border a patch on either side will do.
/// \param direction  unit; downward and vertical too. \throws std::invalid_argument unless it is, and all is finite
/// Cost: patches on the line up to the hit, the reach, or the highest height.
std::optional<ReliefHit> firstHit(const Relief& relief, const Vec3& from, const Vec3& direction);

}  // namespace nacre
