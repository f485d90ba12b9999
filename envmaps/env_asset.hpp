// The asset of kind `environment`: one texture a level, mapping name = layout name.
#pragma once

#include <optional>

#include "core/asset.hpp"
#include "core/environment.hpp"
#include "envmaps/level_mapping.hpp"

namespace nacre {

/// Levels of one layout, finest first, and what they stand for when there are several.
struct EnvChain {
    std::vector<EnvMap> levels;
    std::optional<LevelMapping> mapping;  ///< as many values as levels

    EnvChain() = default;
    explicit EnvChain(EnvMap map) { levels.push_back(std::move(map)); }
};

/// What a shader fetches: sampleEnv of a level, or of two blended by the fraction of `lod` (clamped to the levels).
Rgb sampleChain(const EnvChain& chain, const Vec3& direction, double lod);

struct EnvStorage {
    TexelFormat format = TexelFormat::Half;
    double scale = 1;  ///< the texture holds radiance / scale, and says so: for half floats and suns above 65504
};

/// The power of two, ≥ 1, by which the brightest texel fits half floats.
double scaleForHalf(const EnvChain& chain);

/// Textures level0, level1, …; meta has layout, size, levels, orientation and, for chains, level_mapping. The caller
/// adds source, flip, and what else is known. \throws StorageError when a value doesn't fit the format, naming texel
/// and scale; std::invalid_argument for no level,
///         mixed layouts, Unorm8, a mapping of another length
Asset toAsset(const EnvChain& chain, const EnvStorage& storage = {});

/// \param name  what messages call the file
/// \throws nacre::Error when it is no such asset
EnvChain envFromAsset(const Asset& asset, const std::string& name);

}  // namespace nacre
