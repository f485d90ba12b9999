// The reflectances that the bench bakes: analytic models, published fits, and measured tables on machines that have
// them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "factorize/reflectance.hpp"

namespace nacre::bench {

/// The groups that plots and medians are made over.
enum class Group { Isotropic, SingleLobe, Anisotropic, PublishedFits, MerlTables, RglFiles };
inline constexpr Group kGroups[] = {Group::Isotropic,     Group::SingleLobe, Group::Anisotropic,
                                    Group::PublishedFits, Group::MerlTables, Group::RglFiles};
std::string title(Group group);
/// True for the groups that the bars call measured isotropic RGB.
inline bool isMeasured(Group g) { return g == Group::PublishedFits || g == Group::MerlTables || g == Group::RglFiles; }

struct Material {
    std::string name;  ///< short, unique
    Group group;
    std::string source;  ///< for openReflectance
};

struct MaterialList {
    std::vector<Material> materials;
    std::vector<std::string> notes;  ///< what is missing and why, for the reader
};

struct MaterialOptions {
    std::filesystem::path shared;        ///< holds data/brdf and tools/merl_from_network.py; may be missing
    std::filesystem::path cache;         ///< tables made by that tool are written and kept here (35 MB each)
    bool quick = false;                  ///< a few of each group
    std::vector<std::string> only = {};  ///< names; empty = all
    Progress progress = {};
};

/// \throws std::invalid_argument when a name in `only` is unknown (lists the known ones)
MaterialList benchMaterials(const MaterialOptions& options);

/// The reflectance, and what it is measured against: truthOf.
struct OpenMaterial {
    Reflectance reflectance;
    BrdfFunction truth;
    double openSeconds = 0;
};
/// \throws as openReflectance
OpenMaterial open(const Material& material);

}  // namespace nacre::bench
