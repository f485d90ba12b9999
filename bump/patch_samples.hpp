// Samples of what leaves a relief, patch by patch: a patch's own normal ends at its border, so no filter may cross it.
// A wall one texel wide would lose a quarter of its light to what lies above and below.
#pragma once

#include "bump/height_map.hpp"

namespace nacre {

/// A place along one axis: between the centres of texel `corner` and the next, share 0…1.
struct PatchPlace {
    double corner = 0, share = 0;
};

/// A texture with (k + 1) × (k + 1) texels for each of the relief's: those of a patch lie at the shares 0, 1/k … 1 of
/// it both ways, its corners with its own normal. Along an axis the patch from texel i to i + 1 has the texels from (k
/// + 1) i + (k + 1)/2 on. GLSL twin: nacre_relief_place.
struct PatchSamples {
    int k;  ///< odd, ≥ 1

    PatchPlace of(int texel) const {
        const int from = texel - (k + 1) / 2, corner = from >= 0 ? from / (k + 1) : (from - k) / (k + 1);
        return {static_cast<double>(corner), static_cast<double>(from - corner * (k + 1)) / k};
    }
    /// \param p  of the relief's plane [texels]
    static PatchPlace of(double p) {
        const double corner = std::floor(p - 0.5);
        return {corner, p - 0.5 - corner};
    }
    static double position(const PatchPlace& place) { return place.corner + 0.5 + place.share; }
    /// In the texture's texels, where the bilinear filter blends samples of one patch alone.
    double coordinate(const PatchPlace& place) const {
        return (k + 1) * place.corner + (k + 1) / 2 + 0.5 + k * place.share;
    }
    Vec2 coordinates(const Vec2& p) const { return {coordinate(of(p.x)), coordinate(of(p.y))}; }

    /// Of the patches, unit, RGB; 0 where there is no patch.
    Image normals(const HeightMap& map) const;
    /// As litMask, one channel. \throws std::invalid_argument as refinedRelief
    Image lit(const HeightMap& map, const Vec3& light, unsigned threads = 0) const;
};

}  // namespace nacre
