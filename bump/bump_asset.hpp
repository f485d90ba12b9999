// The asset of kind `bump`: what is baked from one relief, textures addressed by uv.
#pragma once

#include <optional>

#include "bump/height_map.hpp"
#include "bump/horizon_ellipses.hpp"
#include "bump/horizon_map.hpp"
#include "bump/normals.hpp"
#include "bump/scatter_map.hpp"
#include "core/asset.hpp"

namespace nacre {

/// What is there; all of width × height texels (normals: their finest level).
struct BumpMaps {
    int width = 0, height = 0;
    Wrap wrap = Wrap::Repeat;
    std::optional<NormalMap> normals;
    std::optional<HorizonMap> horizons;
    std::optional<EllipseMap> ellipses;
    std::optional<ScatterMap> scatter;
    std::optional<Image>
        indirect;  ///< RGB radiance by one light of irradiance 1, what isn't direct (scattered_light.hpp)
    std::optional<Image> heights;  ///< HeightMap::heights, NaN = hole
};

/// Textures, mapping `uv` (u = x/width along columns, v = y/height along rows, row 0 first, the asset's wrap):
///   normal0, normal1, …    levels, RGB = (x, y, z), A = roughness alpha
///   horizon0, horizon1, …  elevation [rad] towards azimuths 2πk/K, four a texture: part k/4, channel k mod 4
///   ellipse0, ellipse1     (m11, m12, m22); (o1, o2, share of the sky seen)
///   scatter0, scatter1, …  distance [texels] towards directions[k], −1 = miss, four a texture
///   indirect0              RGB radiance by one light of irradiance 1 that has bounced; meta.light says which
///   height0                heights over texel size, always float; holes are meta.hole
/// meta: size, wrap, surface, azimuths, directions, weights, normal_levels, roughness, hole. The caller adds what else
/// is known. Unorm8 is not for scatter maps, whose misses would blur.
/// \throws StorageError when a value doesn't fit the format or an asset of its size couldn't be read back;
///         std::invalid_argument for nothing to store, other sizes than width × height, Unorm8 with a scatter map
Asset toAsset(const BumpMaps& maps, TexelFormat format = TexelFormat::Half);

/// \param name  what messages call the file
/// \throws nacre::Error naming file, part, expected and found when it is no such asset
BumpMaps bumpFromAsset(const Asset& asset, const std::string& name);

}  // namespace nacre
