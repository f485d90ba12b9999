// nacre eval for assets of kind environment.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/asset.hpp"
#include "envmaps/env_asset.hpp"

namespace nacre::cli {

struct EnvQuery {
    Vec3 direction{0};            ///< any length > 0
    std::optional<double> value;  ///< of the chain's parameter; level 0 without
};

/// Reads lines x,y,z or x,y,z,value. Blank lines, lines that start with # and a header that starts with x are skipped.
class EnvQueryReader {
public:
    /// Appends the query of `line`. \throws nacre::Error "standard input: line N: expected …, found …"
    void take(std::string_view line, std::vector<EnvQuery>& queries);

private:
    std::size_t lineNumber_ = 0;
    bool sawContent_ = false;
};

/// r,g,b for each line of standard input: what a shader fetches, trilinear between the chain's levels.
/// \throws nacre::Error also when a line has a value and the asset no level_mapping
void evalEnvironment(const Asset& asset, const std::string& file, unsigned threads);

}  // namespace nacre::cli
