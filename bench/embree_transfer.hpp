// Transfer by rays as fast as Embree gives it: what transfer/ has to beat.
#pragma once

#include <memory>

#include "transfer/self_transfer.hpp"

namespace nacre::bench {

/// Transfer vectors as SelfTransfer's, of order 4, by occlusion rays. One set of directions for all vertices, turned
/// about each normal, with its harmonics in a table; packets of sixteen; the scene is built anew for every frame, in
/// the fast quality; what is hidden is taken from the open hemisphere and turned into the world by HarmonicRotation. So
/// its time is the rays'.
class EmbreeTransfer {
public:
    /// \param rays  a vertex, a multiple of 16 \throws std::invalid_argument; nacre::Error when Embree fails
    EmbreeTransfer(const WeldedMesh& mesh, std::size_t rays);
    ~EmbreeTransfer();
    EmbreeTransfer(EmbreeTransfer&&) noexcept;

    /// \param positions  of the welded vertices, finite. One call at a time.
    TransferFrame compute(std::span<const glm::vec3> positions) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nacre::bench
