// A relief as heights at texel centres, and the one surface that normals, rays, horizons and references take it for.
#pragma once

#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/math.hpp"

namespace nacre {

/// How the relief goes on beyond its borders. Mirror repeats the border texel, as GL_MIRRORED_REPEAT does.
enum class Wrap { Repeat, Clamp, Mirror };

std::string toString(Wrap wrap);  ///< repeat, clamp, mirror
/// \throws std::invalid_argument that lists the known names
Wrap wrapFromString(const std::string& name);

/// Index of texel i of n, for any i.
int wrapIndex(int i, int n, Wrap wrap);

/// The surface: positions p = (x, y) in texels, x along columns (tangent, u = x/width), y along rows from row 0
/// (bitangent, v = y/height), z out of the surface; texel (i, j) is the point (i + 0.5, j + 0.5, heights(i, j)).
/// Between four texel centres the surface is their bilinear patch. Heights are in texel edges too (height / texel
/// size), so slopes and angles are those of the real relief. A NaN is a hole: patches with a hole at a corner don't
/// exist, nothing there blocks a ray or is hit.
struct HeightMap {
    Image heights;  ///< one channel, finite or NaN
    Wrap wrap = Wrap::Repeat;

    int width() const { return heights.width(); }
    int height() const { return heights.height(); }
    /// Height of texel (i, j), any i and j.
    float at(int i, int j) const { return heights.at(wrapIndex(i, width(), wrap), wrapIndex(j, height(), wrap), 0); }
};

/// \throws std::invalid_argument for an empty map, more channels than one, infinite heights
void validateHeightMap(const HeightMap& map);

/// What is seen from a point of the surface ends this many texels away (along the plane): blockers beyond are left out.
/// They would be under atan(range of heights / reach) above the horizontal. 16 tiles and 1024 texels.
double reachOf(const HeightMap& map);

/// Height of the surface at p [texels]; NaN where there is none.
double heightAt(const HeightMap& map, const Vec2& p);

/// Lowest and highest height; both 0 when all is hole.
struct HeightRange {
    double low = 0, high = 0;
};
HeightRange heightRange(const HeightMap& map);

}  // namespace nacre
