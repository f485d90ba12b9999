// The gallery's entries as plain data: what is baked, on what it is shown, and what a reader is told.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "factorize/factorize.hpp"

namespace nacre {

struct Recipe {
    std::string id, section, title, caption;
    std::string stage;            ///< as openStage takes it
    std::string source;           ///< as openReflectance takes it
    FactorizeOptions bake;        ///< the command line is made from this too
    double white = 0;             ///< radiance shown as white; 0 = pictureWhite of the reference
    bool allAddressings = false;  ///< also per vertex and by texture matrices
};

/// \param brdfFolder  holds measured files (.bsdf, .binary) on machines that have them: one more entry each. May be
///                    empty or missing
std::vector<Recipe> galleryRecipes(const std::filesystem::path& brdfFolder);

/// `nacre factorize SOURCE -o ID.exr …`: bakes what recipe.bake says. Quoted for a POSIX shell.
std::string bakeCommand(const Recipe& recipe);

/// In single quotes unless it is made of letters, digits and _-+=:,./@% alone.
std::string shellQuoted(const std::string& text);

}  // namespace nacre
