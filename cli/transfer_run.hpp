// What `nacre transfer` does: all frames computed and timed, and their error measured.
#pragma once

#include <optional>

#include "core/progress.hpp"
#include "reference/transfer_trace.hpp"
#include "transfer/self_transfer.hpp"
#include "transfer/transfer_file.hpp"

namespace nacre::cli {

struct TransferRun {
    TransferRecording recording;
    std::vector<int> refused;       ///< frames with positions that aren't finite
    std::size_t reused = 0;         ///< frames in which nothing moved
    std::size_t computed = 0;       ///< vertices of all computed frames
    std::size_t withoutNormal = 0;  ///< vertices, most in any frame
    std::size_t joined = 0;         ///< vertices of the model that are one with others, though not quite at their place
    double wallSeconds = 0;         ///< of compute() alone, after one frame to warm up
    TransferSeconds seconds;        ///< of all threads together
    double listed = 0, drawn = 0;   ///< blockers a vertex, mean
    std::size_t coarse = 0;         ///< as was used: SelfTransferOptions::coarse
    std::size_t coarseTriangles = 0;
    std::size_t bytes = 0;  ///< SelfTransfer::bytes; 0: the paper's method
    bool closed = false;
    BlockingSides sides = BlockingSides::Auto;
    struct Sets {
        bool made = false;  ///< from these frames, and written
        std::size_t windows = 0, bytes = 0;
        double share = 0;    ///< of all pairs of group and blocker, mean over windows
        double seconds = 0;  ///< that making or reading them took
    };
    std::optional<Sets> sets{};
};

/// Phong's lobe for one viewer.
struct GlossPlan {
    double exponent = 0, specular = 0.5;
    std::optional<Vec3> eye{};  ///< none: where `nacre render` looks from, cameraSeeing all frames
};

struct TransferPlan {
    int first = 0, end = 0;  ///< frames first … end − 1
    SelfTransferOptions options;
    bool poses = false;                ///< whether the animation is the whole motion, for SelfTransfer's poses
    std::optional<GlossPlan> gloss{};  ///< without sets
    std::string visibleSets{};  ///< file of potentially visible sets: read when it is there, else made and written
    int windowFrames = 0;       ///< of a set that is made; 0 = all
    std::optional<int> lut{};   ///< by PaperMethod with this table, and rings, coarse, sides and threads of the options
};

/// \throws nacre::Error naming the animation when no frame has finite positions, the sets' file when it can't be read
/// or is of another mesh, other levels of detail or other frames
TransferRun runTransfer(const AnimatedMesh& animation, const TransferPlan& plan, const std::string& name,
                        const Progress& progress);

/// A frame's truth by rays, with the recording's gloss: [vertex][coefficients], 0 for vertices without a normal.
std::vector<double> tracedVectors(const TransferRecording& recording, const TransferRecording::Block& block,
                                  std::size_t rays);

struct TransferMeasure {
    TransferError error;
    std::vector<int> frames;  ///< that were traced
};

/// Against rays, over all vertices that have a normal, in frames spread over those that are there.
/// \param rays  a vertex \param frames  at most so many
TransferMeasure measureTransfer(const TransferRecording& recording, std::size_t rays, int frames,
                                const Progress& progress);

}  // namespace nacre::cli
