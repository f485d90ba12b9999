// The longer sections of the panel.
#pragma once

#include "demos/viewer/panel.hpp"

namespace nacre {

/// Notes where the item that was drawn last stands.
void notePlace(PanelState& state, const std::string& name);

void materialSection(ViewerSession& session, PanelState& state);
void lightSection(ViewerSession& session, PanelState& state);
void assetSection(ViewerSession& session, PanelState& state);
/// The passes of the last picture, and which of its views are drawn.
void passesSection(ViewerSession& session, PanelState& state);
/// The time that frames are to keep.
void qualitySection(ViewerSession& session);
void comparisonStatus(Comparison& comparison);

}  // namespace nacre
