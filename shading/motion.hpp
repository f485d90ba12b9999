// The one door to meshes that move: a file, or what is built in.
#pragma once

#include "shading/animated_mesh_file.hpp"

namespace nacre {

struct MotionOptions {
    std::string clip;                   ///< of a file
    double framesPerSecond = 0;         ///< 0: the file's; 30 for what is built in
    int frames = 0;                     ///< the first so many; 0: all (cloth: 300)
    std::uint64_t seed = 1;             ///< of the cloth's breeze
    std::filesystem::path chessPieces;  ///< king.obj … pawn.obj as brutalchess has them; empty: turned pieces
    std::function<void(const std::string&)> note{};
};

/// \param name  "cloth" (transfer/cloth.hpp), "chess" (transfer/chess.hpp), or a file (animated_mesh_file.hpp)
/// \throws nacre::Error naming it: neither a file nor built in (with what is), a piece that is missing, and as
///         loadAnimatedMesh; std::invalid_argument for a clip of what is built in, and negative numbers
AnimatedMesh loadMotion(const std::string& name, const MotionOptions& options = {});

}  // namespace nacre
