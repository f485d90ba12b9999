// Light transfer of a moving mesh played in light that turns and blends: from a file, or computed as it is shown.
#pragma once

#include <variant>

#include "shading/scene_bounds.hpp"
#include "shading/vertex_light_pass.hpp"
#include "transfer/exitant_radiance.hpp"
#include "transfer/live_transfer.hpp"
#include "transfer/transfer_file.hpp"

namespace nacre {

/// Environments that light together.
struct PlayedLight {
    std::vector<LightCoefficients> environments;  ///< of the transfer's order, at least one
    std::vector<double> weights;                  ///< one each
    double turn = 0;                              ///< all about y, from +z towards +x [rad]
    bool operator==(const PlayedLight&) const = default;
};

/// The context that is current in the constructor must be current in draw().
class TransferPlayer {
public:
    explicit TransferPlayer(TransferRecording recording);
    explicit TransferPlayer(LiveTransfer live);

    std::size_t frameCount() const;
    int frameNumber(std::size_t frame) const;  ///< of the animation: frames that a file lacks leave gaps
    double framesPerSecond() const;
    double duration() const { return static_cast<double>(frameCount()) / framesPerSecond(); }  ///< [s]
    /// The frame at a time [s] of the animation, which repeats.
    std::size_t frameAt(double time) const;
    int order() const { return rotation_.order(); }
    std::size_t vertexCount() const;
    const std::vector<glm::uvec3>& triangles() const;
    /// A box about all frames, those left out that aren't finite.
    const SceneBounds& bounds() const { return bounds_; }
    /// cameraSeeing the bounds; from where a recording's gloss is seen.
    Camera standardCamera() const;
    /// Null when it is computed live.
    const TransferRecording* recording() const { return std::get_if<TransferRecording>(&source_); }

    /// What the last draw() did.
    struct Cost {
        std::size_t computed = 0;    ///< vertices whose transfer was computed
        double transferSeconds = 0;  ///< for it
        double lightSeconds = 0;     ///< for light and radiance
    };

    /// Draws into `target`, which it doesn't clear (vertex_light_pass.hpp). Radiance is `albedo` times the sum over
    /// coefficients: of all vertices from a file; live of those that face the camera.
    /// \throws std::invalid_argument for a frame that isn't there, and light of another order; nacre::Error naming a
    ///         frame with positions that aren't finite, and from the shaders
    void draw(ProgramLoader& loader, const RenderTarget& target, const Camera& camera, std::size_t frame,
              const PlayedLight& light, const Rgb& albedo = Rgb(1));
    const Cost& cost() const { return cost_; }

    /// The same with other transfer vectors, the frame's truth for instance. \param transfer  [vertex][coefficients]
    void drawWith(std::span<const float> transfer, ProgramLoader& loader, const RenderTarget& target,
                  const Camera& camera, std::size_t frame, const PlayedLight& light, const Rgb& albedo = Rgb(1));

private:
    const std::vector<glm::vec3>& positions(std::size_t frame) const;

    std::variant<TransferRecording, LiveTransfer> source_;
    HarmonicRotation rotation_;
    GpuVertexLight gpu_;
    SceneBounds bounds_;
    Cost cost_;
};

/// The light's coefficients. \throws std::invalid_argument as blendedLights and turnedLight
LightCoefficients coefficientsOf(const PlayedLight& light, const HarmonicRotation& rotation);

/// Radiance 1 from everywhere.
LightCoefficients whiteLight(int order);

/// cameraSeeing from another side. \param azimuth  about y from +z towards +x \param elevation  below π/2 [rad]
Camera cameraAround(const SceneBounds& bounds, double azimuth, double elevation);

}  // namespace nacre
