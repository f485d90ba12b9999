// Transfer of a moving mesh while it is shown: of what the viewer can see, and nothing twice (HEMI section 3,
// "Rendering").
#pragma once

#include <optional>

#include "transfer/self_transfer.hpp"

namespace nacre {

/// Keeps one frame's transfer vectors. A frame in which nothing moved keeps the last one's, and vertices that come into
/// view by the viewer's move alone are added to those that are there.
class LiveTransfer {
public:
    /// \throws std::invalid_argument and nacre::Error as weldMesh and SelfTransfer; nacre::Error naming `name` when no
    ///         frame has finite positions
    LiveTransfer(const AnimatedMesh& animation, const std::string& name, const SelfTransferOptions& options = {});

    /// Computes what isn't known of the vertices that face the eye (frontFacing); \param eye  none: all of them.
    /// \throws std::invalid_argument for a frame that isn't there; nacre::Error naming the frame whose positions aren't
    ///         finite: what was shown before stays
    void show(std::size_t frame, const std::optional<Vec3>& eye);

    const SelfTransfer& transfer() const { return transfer_; }
    std::size_t frameCount() const { return frames_.size(); }
    double framesPerSecond() const { return framesPerSecond_; }
    const std::vector<std::vector<glm::vec3>>& frames() const { return frames_; }  ///< positions of the welded vertices

    // The frame shown.
    const std::vector<glm::vec3>& positions() const { return positions_; }
    const std::vector<float>& coefficients() const { return coefficients_; }  ///< zeros where nothing is known
    std::size_t computed() const { return computed_; }                        ///< vertices, by the last show()

private:
    std::string name_;
    double framesPerSecond_;
    std::vector<std::vector<glm::vec3>> frames_;
    SelfTransfer transfer_;
    std::vector<glm::vec3> positions_;
    std::vector<float> coefficients_;
    std::vector<std::uint8_t> known_;
    std::size_t computed_ = 0;
};

}  // namespace nacre
