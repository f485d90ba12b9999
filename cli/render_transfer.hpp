// `nacre render` of what `nacre transfer` wrote: its frames as pictures, in light that turns and blends.
#pragma once

#include <optional>

#include "cli/frame_range.hpp"
#include "cli/scene_errors.hpp"
#include "cli/transfer_light.hpp"
#include "cli/verb.hpp"

namespace nacre::cli {

struct TransferPictures {
    std::string file, output;
    SceneShot shot;  ///< without its time
    std::optional<FrameRange> frames{};
    TransferLight light;
    double fromDeg = 0;             ///< the light's turn at frame 0 [degrees]
    std::optional<Vec2> viewDeg{};  ///< azimuth from +z towards +x, elevation [degrees]; none: cameraSeeing
    bool reference = false;
    std::size_t rays = 1024;  ///< of the reference, a vertex
    bool asJson = false;
};

/// \throws UsageError for frames that aren't there; nacre::Error for files that can't be read or written
void renderTransfer(const Context& context, const TransferPictures& pictures);

}  // namespace nacre::cli
