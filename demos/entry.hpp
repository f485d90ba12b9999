// One entry of the gallery from its recipe: bake, measure, render, ray trace, compare, time.
#pragma once

#include <filesystem>
#include <map>

#include "demos/page.hpp"
#include "demos/recipe.hpp"
#include "demos/stage.hpp"
#include "shading/program.hpp"

namespace nacre {

/// What was baked in this run, by its command without the output's name: entries that share an asset bake it once.
struct Baked {
    FactoredBrdf brdf;
    AssetFacts facts;
};
using BakedCache = std::map<std::string, Baked>;

struct EntryOptions {
    std::filesystem::path folder;    ///< gets the asset; the pictures' names are relative to it
    int size = 448;                  ///< edge of a square picture; others have as many pixels
    std::uint64_t samples = 200000;  ///< of the reflectance's error
    int timingRepeats = 5;
    Progress progress;
};

/// Bakes unless `baked` has it, and adds it there. Pictures are drawn with 2 × 2 samples a pixel, the reference at the
/// same points; frame times are of these frames. The exposure is the reference's (pictureWhite, or the recipe's)
/// for all pictures of the entry. A context must be current. \throws nacre::Error and std::invalid_argument of the
/// baker, the reader and the driver
Entry makeEntry(const Recipe& recipe, const Stage& stage, ProgramLoader& loader, BakedCache& baked,
                const EntryOptions& options);

}  // namespace nacre
