// What the exhibits of reliefs share.
#pragma once

#include "bump/bump_asset.hpp"
#include "demos/exhibit_task.hpp"
#include "shading/lit_pass.hpp"

namespace nacre {

constexpr double kReliefRise = 24;  ///< of the heights, black to white [texels]

/// Normals, ellipses, and horizons of 16 azimuths.
BumpMaps bumpMapsOf(const HeightMap& map);

/// A square that fills the picture, seen from straight above: u to the right, v upwards.
Body planeBody(int size);

/// A lamp at an azimuth from u towards v and an elevation above the plane [degrees], which makes a facing white surface
/// white.
Light lampFromDeg(double azimuthDeg, double elevationDeg);

/// bump_indirect.cpp
Exhibit indirectExhibit(const Task& task);

}  // namespace nacre
