// The gallery's exhibits: environment maps (HSE figure 5, roughness sweeps, orientation) and bump maps (HSE figures 9
// and 13), shadow maps, scenes, volumes, transfer of moving meshes (HEMI's figures and tables).
#pragma once

#include <filesystem>

#include "core/progress.hpp"
#include "demos/exhibit.hpp"
#include "shading/program.hpp"

namespace nacre {

struct ExhibitOptions {
    std::filesystem::path worldFolder;     ///< holds NAME.exr, \see demos/fetch.sh
    std::filesystem::path heightFolder;    ///< holds NAME.bmp, the same
    std::filesystem::path sceneFolder;     ///< holds NAME.json, whose assets are baked: demos/scenes
    std::filesystem::path volumeFolder;    ///< holds NAME.inr, \see demos/fetch.sh
    std::filesystem::path meshFolder;      ///< holds NAME.off, the same
    std::filesystem::path animatedFolder;  ///< holds meshes that move, the same
    bool quick = false;                    ///< pictures of half the edge, coarser surroundings
    int timingRepeats = 5;
    Progress progress{};
};

/// Ids, in the page's order.
std::vector<std::string> exhibitIds();

/// A context must be current. \param notes  gets what stands in for missing files
/// \throws std::invalid_argument for an unknown id; nacre::Error of reader and driver
Exhibit makeExhibit(const std::string& id, ProgramLoader& loader, const ExhibitOptions& options,
                    std::vector<std::string>& notes);

}  // namespace nacre
