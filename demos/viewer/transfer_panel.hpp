// The panel beside a moving mesh: Dear ImGui alone, no OpenGL.
#pragma once

#include "demos/viewer/transfer_session.hpp"

namespace nacre {

/// What the user has chosen, beyond the session.
struct TransferPanelState {
    bool open = true;
    double white = 1;
    double frameSeconds = 0;  ///< smoothed, of whole frames
    std::string note, device;
    bool wantsScreenshot = false, wantsAutoExposure = false;
};

/// Between Gui::begin and Gui::draw. \param height  of the window
void drawTransferPanel(TransferSession& session, TransferPanelState& state, int height);

}  // namespace nacre
