// The techniques of nacre bump: what is asked for into maps, with the time of each; budgets.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bump/bump_asset.hpp"
#include "bump/scattered_light.hpp"
#include "cli/bump_measure.hpp"
#include "core/progress.hpp"

namespace nacre::cli {

struct BumpRequest {
    bool normals = false, roughness = false, ellipses = false, heights = false;
    int horizon = 0;              ///< azimuths of the horizon map; 0 = none
    int scatter = 0;              ///< directions of the scatter map; 0 = none
    bool indirect = false;        ///< light that bounces, by `light`
    ScatteredLightOptions light;  ///< of irradiance 1
    EllipseOptions fit;
    TexelFormat format = TexelFormat::Half;
    std::optional<double> maxError;  ///< of the shadows: share of the pairs (texel, light) misjudged
    std::optional<std::size_t> maxBytes;
    unsigned threads = 0;
};

struct BumpBake {
    EllipseOptions fit;    ///< of maps.ellipses: a budget chooses its directions
    ScatteredLight light;  ///< with maps.indirect: all of it
    BumpMaps maps;         ///< as baked; what is stored is rounded
    nlohmann::json times =
        nlohmann::json::object();  ///< one object a technique: seconds, cpu_seconds, texels, horizons or rays a second
    double seconds = 0, cpuSeconds = 0;
    double searchSeconds = 0;  ///< of bakes and measurements that a budget has made and left
};

/// Bakes what is asked for. With maxError the shadows are the first of these within it: ellipses of 32, 64, …
/// directions up to fit.directions; horizon maps of 8, 16, … azimuths up to 256, or up to `horizon` where that is asked
/// for. \throws nacre::Error when the budgets can't be met, saying how near it came; `output` is what messages call it
BumpBake bakeBump(const HeightMap& map, const BumpRequest& request, const std::string& output,
                  const Progress& progress);

/// The maps as a reader of the file gets them.
BumpMaps asStored(const BumpMaps& maps, TexelFormat format, const std::string& output);

}  // namespace nacre::cli
