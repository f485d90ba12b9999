#include "shading/motion.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "shading/mesh_file.hpp"
#include "transfer/chess.hpp"
#include "transfer/cloth.hpp"

namespace nacre {

namespace fs = std::filesystem;

static AnimatedMesh cloth(const MotionOptions& options) {
    ClothOptions out;
    if (options.frames > 0) out.frames = options.frames;
    if (options.framesPerSecond > 0) out.framesPerSecond = options.framesPerSecond;
    out.seed = options.seed;
    return clothAnimation(out);
}

static AnimatedMesh chess(const MotionOptions& options) {
    ChessOptions out;
    out.frames = options.frames;
    if (options.framesPerSecond > 0) out.framesPerSecond = options.framesPerSecond;
    if (options.chessPieces.empty()) return chessAnimation(turnedChessSet(), out);
    ChessSet set;
    const char* const names[] = {"king", "queen", "rook", "bishop", "knight", "pawn"};
    for (std::size_t i = 0; i < set.size(); ++i) {
        set[i] = loadMesh(options.chessPieces / (std::string(names[i]) + ".obj")).mesh;
        for (glm::vec3& p : set[i].positions) p = {-p.z, p.y, p.x};  // brutalchess's look along −x, ours along −z
    }
    return chessAnimation(set, out);
}

AnimatedMesh loadMotion(const std::string& name, const MotionOptions& options) {
    require(options.frames >= 0, "loadMotion: frames must be >= 0");
    require(std::isfinite(options.framesPerSecond) && options.framesPerSecond >= 0,
            "loadMotion: frames per second must be finite and >= 0");
    if (name == "cloth" || name == "chess") {
        require(options.clip.empty(), fmt::format("loadMotion: {} has no clips, found \"{}\"", name, options.clip));
        return name == "cloth" ? cloth(options) : chess(options);
    }
    std::error_code ignored;
    if (!fs::exists(name, ignored))
        throw Error(fmt::format("{}: expected a file, or one of cloth, chess; found neither", name));
    AnimatedMesh out = loadAnimatedMesh(name, {options.clip, options.framesPerSecond, options.note});
    if (options.frames > 0 && static_cast<std::size_t>(options.frames) < out.frames.size())
        out.frames.resize(static_cast<std::size_t>(options.frames));
    return out;
}

}  // namespace nacre
