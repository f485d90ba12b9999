// The lobes of nacre envmap: options into levels, levels into JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/verb.hpp"
#include "envmaps/env_asset.hpp"
#include "envmaps/prefilter.hpp"

namespace nacre::cli {

struct LobeSettings {
    std::string lobe;    ///< empty = none asked for
    std::string values;  ///< of a chain, comma-separated
    std::optional<double> exponent, alpha, alphaY, ior, tolerance, maxError;
    std::optional<Vec3> axis;
    std::optional<std::size_t> maxBytes;
    int chain = 0;  ///< levels; 0 = one map
    bool verify = false;
    int samples = 300;
};

std::vector<Option> lobeOptions(LobeSettings& settings);

/// The lobes of the levels, finest first, and what they stand for.
struct LobeChain {
    std::vector<Lobe> lobes;
    std::optional<LevelMapping> mapping;
};
/// \throws UsageError for options that the lobe doesn't take or lacks
LobeChain lobeChain(const LobeSettings& settings);

struct LobeBake {
    EnvChain chain;
    nlohmann::json levels;  ///< one object a level: size, exponent or alpha, how it was computed
    nlohmann::json error;   ///< what a budget of error has measured; null without
};
/// The first option of a lobe that is set; empty when none is.
std::string anyLobeOption(const LobeSettings& settings);

/// Level m has size >> m. With a budget: the smallest size, a power of two, within maxError (measured between the
/// texels, through the filter), or the largest within maxBytes. \throws nacre::Error when none is, saying how near it
/// came
LobeBake bakeLobes(const LobeSettings& settings, const EnvMap& source, EnvLayout layout, int size, TexelFormat format,
                   const PrefilterOptions& options);

/// The error of each level as stored, against reference/environment_error.hpp; mirrors have none.
nlohmann::json verifyLobes(const LobeSettings& settings, const EnvMap& source, const EnvChain& written,
                           unsigned threads, const Progress& progress);

}  // namespace nacre::cli
