// The gallery's exhibits of environment maps: HSE figure 5, roughness sweeps, orientation.
#pragma once

#include <filesystem>

#include "core/progress.hpp"
#include "demos/exhibit.hpp"
#include "shading/program.hpp"

namespace nacre {

struct ExhibitOptions {
    std::filesystem::path worldFolder;  ///< holds NAME.exr, \see demos/fetch.sh
    bool quick = false;                 ///< pictures of half the edge, coarser surroundings
    int timingRepeats = 5;
    Progress progress{};
};

/// Ids, in the page's order.
std::vector<std::string> environmentExhibitIds();

/// A context must be current. \param notes  gets what stands in for missing maps
/// \throws std::invalid_argument for an unknown id; nacre::Error of reader and driver
Exhibit makeEnvironmentExhibit(const std::string& id, ProgramLoader& loader, const ExhibitOptions& options,
                               std::vector<std::string>& notes);

}  // namespace nacre
