// What transfer is measured on: animated meshes from files, and what is built in.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "transfer/surface.hpp"

namespace nacre::bench {

struct TransferMesh {
    std::string name;
    WeldedMesh mesh;
    std::vector<glm::vec3> rest;                 ///< the clip's first frame, by which levels are made
    std::vector<std::vector<glm::vec3>> poses;   ///< motionPoses
    std::vector<std::vector<glm::vec3>> frames;  ///< three that are measured: after 1/6, 3/6 and 5/6 of the clip
};

struct TransferMeshList {
    std::vector<TransferMesh> meshes;
    std::vector<std::string> notes;  ///< what wasn't found
};

/// $NACRE_ANIMATED, else build/data/animated.
std::filesystem::path animatedFolder();

/// Cloth, chess and a closed tube, and of Debian's assimp-testmodels and the webxr-input-profiles the runner, dancer,
/// fixer and hand, where they are somewhere in the folder. \param quick  the cloth, and the first file that is
/// there
TransferMeshList transferMeshes(const std::filesystem::path& folder = animatedFolder(), bool quick = false);

/// The same surface with each triangle cut into four at its edges' middles: about four times the vertices.
TransferMesh subdivided(const TransferMesh& mesh);

}  // namespace nacre::bench
