// What a shader gets out of a bump asset at a point (u, v): the lookups in C++. Directions are the surface's; in
// mirrored tiles the relief is turned over, and they with it.
#pragma once

#include <array>
#include <optional>

#include "bump/bump_asset.hpp"

namespace nacre {

/// GL_LINEAR with GL_REPEAT, GL_CLAMP_TO_EDGE or GL_MIRRORED_REPEAT at any finite (u, v); weights in single precision.
/// Channels that the image lacks are 0.
std::array<float, 4> sampleWrapped(const Image& image, double u, double v, Wrap wrap);

/// ≥ 0 where the light's direction (unit) is lit: of the ellipses when there are any, 1 − |M l + o|², else the light's
/// elevation over the horizon's [rad], linear between azimuths; the stored numbers are blended first. Light from below
/// the plane (lz < 0) is −1: never lit.
/// \throws std::invalid_argument when the maps have neither
double litMargin(const BumpMaps& maps, double u, double v, const Vec3& light);

/// Index of the stored direction that is nearest to `direction` (unit), the first of equals.
std::size_t nearestDirection(const ScatterMap& map, const Vec3& direction);

struct Seen {
    bool hit = false;
    Vec2 uv{0};  ///< of the point seen, from the first tile (unturned); beyond [0, 1] where the ray crosses a border
    std::size_t direction = 0;  ///< the stored one
};

/// Nearest texel, nearest stored direction: distances across an edge can't be blended.
/// \throws std::invalid_argument when the maps have no scatter map
Seen seenFrom(const BumpMaps& maps, double u, double v, const Vec3& direction);

/// Unit, of the finest level, bilinear. \throws std::invalid_argument when the maps have no normals
Vec3 normalAt(const BumpMaps& maps, double u, double v);

}  // namespace nacre
