// Soft self-shadows of moving meshes: error over vertices a second of ours, of HEMI's own method and of rays; and the
// bars.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bars.hpp"
#include "bench/transfer_meshes.hpp"
#include "core/progress.hpp"
#include "transfer/paper_method.hpp"

namespace nacre::bench {

/// One way to compute transfer vectors of one mesh.
struct TransferContender {
    std::string method, setting;
    std::function<TransferFrame(std::span<const glm::vec3>)> compute;
};

struct TransferMeasurement {
    std::string mesh, method, setting;
    std::size_t vertices = 0;      ///< computed in a frame
    double listed = 0, drawn = 0;  ///< blockers a vertex; 0 of rays
    double error = 0, total = 0;   ///< TransferError's mean and total
    double noise = 0;              ///< what the truth itself may be off: mean between it and a set of 3/4 the rays
    double cpuSeconds = 0;         ///< of a frame, all threads together
    double wallSeconds = 0;        ///< of a frame on this machine as busy as it was
    TransferSeconds seconds;       ///< where the CPU's time goes; 0 of rays
    /// Of two threads: what the CPU's time gives when nothing else wants the processor.
    double verticesPerSecond() const { return 2 * static_cast<double>(vertices) / cpuSeconds; }
};

/// The settings that the bars are promised for.
SelfTransferOptions quickTransfer();    ///< with levels: just below 3 % on meshes of 3000 vertices
SelfTransferOptions largeTransfer();    ///< with levels: below 3 % on meshes of 8000 vertices
SelfTransferOptions fastTransfer();     ///< about 1 %, below 3 %
SelfTransferOptions qualityTransfer();  ///< about 0.4 %, below 1.5 %
std::string text(const SelfTransferOptions& options);
std::string text(const PaperMethodOptions& options);

TransferContender ours(const TransferMesh& mesh, const SelfTransferOptions& options);
TransferContender papers(const TransferMesh& mesh, const PaperMethodOptions& options);
TransferContender embree(const TransferMesh& mesh, std::size_t rays);

struct TransferSweepOptions {
    bool quick = false;         ///< few settings, fewer rays of the truth
    int repeats = 5;            ///< of the timing
    std::size_t sampled = 200;  ///< vertices of each frame that errors are measured at
    std::size_t rays = 16384;   ///< of the truth
    Progress progress{};
};

/// All contenders on the mesh's frames: errors once; times as medians over repeats, in each of which every contender
/// computes every frame. Contenders that take more than a second a frame are timed in the first three repeats alone.
std::vector<TransferMeasurement> measureTransfer(const TransferMesh& mesh,
                                                 const std::vector<TransferContender>& contenders,
                                                 const TransferSweepOptions& options);

/// Every knob: mask, levels of detail, the paper's table, rays.
std::vector<TransferMeasurement> sweepTransfer(const std::vector<TransferMesh>& meshes,
                                               const TransferSweepOptions& options);

/// CPU seconds a vertex that Embree needs for an error: between its measurements on a straight line of logarithms,
/// beyond them on the nearest two's. 0 where there are fewer than two.
double embreeSecondsAt(const std::vector<TransferMeasurement>& ofMesh, double error);

/// What transfer promises; the worst mesh decides. Times count CPU seconds, as if two threads had two processors.
std::vector<Bar> measureTransferBars(const std::vector<TransferMesh>& meshes, const TransferSweepOptions& options,
                                     std::vector<TransferMeasurement>* kept = nullptr);

/// Section of the page.
std::string transferSection(const std::vector<TransferMeasurement>& measurements);
nlohmann::json transferJson(const TransferMeasurement& measurement);

}  // namespace nacre::bench
