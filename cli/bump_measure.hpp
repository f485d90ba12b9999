// How wrong what nacre bump has stored is, against reference/bump_error.hpp.
#pragma once

#include <nlohmann/json.hpp>

#include "bump/bump_asset.hpp"
#include "bump/scattered_light.hpp"
#include "core/progress.hpp"
#include "reference/bump_error.hpp"

namespace nacre::cli {

inline constexpr int kBumpSamples = 20000;
inline constexpr std::uint64_t kBumpSeed = 1;

/// Of the lookups that a shader does at texel centres: ellipses, or horizons without any.
LitError measureShadows(const LitSamples& samples, const BumpMaps& stored);

/// One object a technique that is stored:
///   ellipses  misjudged, misjudged_radii_only (the same directions, EllipseFit::Radii), dark (of calling all lit),
///   samples horizon   max_rad, share_within_1e-3, rmse_deg (all, along the axes, of the worst azimuth), misjudged,
///   samples scatter   hit_mismatch, beyond_one_texel, hits, samples
/// \param options  that the ellipses were fitted with
nlohmann::json measureBump(const HeightMap& map, const BumpMaps& stored, const EllipseOptions& options,
                           TexelFormat format, const Progress& progress);

/// Of light that bounced: relative_rmse, of all but the direct light, and of the total; noise, the truth's own share of
/// the first; samples. \param light  with `indirect` as stored
nlohmann::json measureIndirect(const HeightMap& map, const ScatteredLight& light, const ScatteredLightOptions& options,
                               const Progress& progress);

}  // namespace nacre::cli
