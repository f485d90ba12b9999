// A moving mesh in a surrounding's light, frame by frame: shadowed by SelfTransfer, by rays, and not at all.
#pragma once

#include "demos/exhibit_task.hpp"
#include "envmaps/spherical_harmonics.hpp"
#include "reference/transfer_trace.hpp"
#include "shading/vertex_light_pass.hpp"
#include "transfer/self_transfer.hpp"

namespace nacre {

/// What moves, which of it is shown, and from where.
struct TransferModel {
    std::string motion;  ///< cloth, chess, or a file in ExhibitOptions::animatedFolder
    std::string words;
    std::vector<double> shown;  ///< frames, as shares of the clip
    double azimuthDeg = 20, elevationDeg = 25, zoom = 1;
    int boardVertices = 0;  ///< of chess: along an edge of a board with turned pieces; 0: loadMotion's
};

/// One frame shown; transfer vectors of all welded vertices.
struct TransferStudyFrame {
    std::vector<glm::vec3> positions, normals;
    std::vector<float> open;              ///< nothing shadows: by the normal alone
    std::vector<float> truth;             ///< by rays
    TransferError error, withoutShadows;  ///< of SelfTransfer, and of `open`
    double listed = 0, drawn = 0;         ///< blockers a vertex
    TransferSeconds seconds;
};

/// A model opened.
struct ShownMotion {
    AnimatedMesh animation;
    std::vector<std::size_t> frames;  ///< of it, shown
    Camera camera;                    ///< sees all of these
    std::string command;              ///< what a command line calls it; empty: nothing there does
    bool standsIn = false;            ///< for a file that isn't there
};
/// Where the file isn't there another cloth stands in, and task.notes says so.
ShownMotion openMotion(const Task& task, const TransferModel& model);

class TransferStudy {
public:
    /// \param rays  a vertex, of the truth
    TransferStudy(ProgramLoader& loader, const ShownMotion& motion, std::size_t rays,
                  const SelfTransferOptions& options = {});

    const std::vector<TransferStudyFrame>& frames() const { return frames_; }
    const SelfTransfer& transfer() const { return transfer_; }

    using Draw = std::function<void(const RenderTarget&)>;
    /// All that a frame costs: the vertices that face the camera are computed, dotted with the light, uploaded, drawn.
    /// What these refer to is this study and the light.
    Draw shadowed(std::size_t frame, const SphericalHarmonics& light);
    Draw withoutShadows(std::size_t frame, const SphericalHarmonics& light);
    /// The truth's vectors.
    Draw rayTraced(std::size_t frame, const SphericalHarmonics& light);
    /// Rays at every sample of the picture: what vertices undersample. \param rays  a sample
    RaytracedPicture tracedPixels(std::size_t frame, const SphericalHarmonics& light, int size, std::size_t rays) const;

    /// Of SelfTransfer::compute, all cores, mean of the shown frames; medians of repeats.
    struct Seconds {
        double all = 0, facing = 0;  ///< all vertices; those that face the camera
    };
    Seconds secondsAFrame(int repeats) const;

private:
    void addFrame(std::vector<glm::vec3> positions, std::size_t rays);
    void draw(const RenderTarget& target, std::size_t frame, std::span<const glm::vec3> radiance);

    ProgramLoader& loader_;
    Camera camera_;
    SelfTransfer transfer_;
    GpuVertexLight gpu_;
    std::vector<TransferStudyFrame> frames_;
};

/// What `draw` draws, as the reference of ExhibitBuilder::panel.
RaytracedPicture pictureOf(const TransferStudy::Draw& draw, int size);

struct TransferLight {
    SphericalHarmonics coefficients;  ///< to order 4, without a window
    std::string file, words;          ///< of the surrounding
};
/// Notes what stands in.
TransferLight transferLight(const Task& task, const std::string& surrounding);

}  // namespace nacre
