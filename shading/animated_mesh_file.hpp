// Animated meshes from files: skinned and morphed ones (glTF, FBX, .X and whatever else assimp reads; IQM), moving
// nodes, key frames (MD2).
#pragma once

#include <filesystem>
#include <functional>

#include "core/animation.hpp"

namespace nacre {

struct AnimatedMeshOptions {
    std::string clip;                                ///< by its name or its place in animationClips; "": the first
    double framesPerSecond = 0;                      ///< 0: the file's, else 30 (see assimp_rig.hpp, md2_frames.hpp)
    std::function<void(const std::string&)> note{};  ///< is told what was left out or read differently
};

struct AnimationClip {
    std::string name;
    double seconds = 0;
};

/// The clips of a file, in its order; none when nothing in it moves. A rigged hand without a clip has one of ours
/// (hand_motion.hpp). \throws nacre::Error as loadAnimatedMesh
std::vector<AnimationClip> animationClips(const std::filesystem::path& path);

/// All meshes of the file together, in the scene's coordinates, at the times i / framesPerSecond of a clip (see
/// rig.hpp). A clip of no length and a file without clips are one frame. Keys that aren't finite make the frames that
/// they touch non-finite, and no others. Vertices are the file's: transfer/surface.hpp joins those that stay together.
/// \throws nacre::Error naming the path: unreadable or unknown format (with assimp's message), a clip that isn't there
///         (with those that are), no triangle; and what rig.hpp, iqm_file.hpp and assimp_rig.hpp say
/// \throws std::invalid_argument for a rate that isn't finite and >= 0
AnimatedMesh loadAnimatedMesh(const std::filesystem::path& path, const AnimatedMeshOptions& options = {});

}  // namespace nacre
