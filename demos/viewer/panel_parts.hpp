// The longer sections of the panel.
#pragma once

#include "demos/viewer/panel.hpp"

namespace nacre {

void materialSection(ViewerSession& session, PanelState& state);
void lightSection(ViewerSession& session, PanelState& state);
void assetSection(ViewerSession& session, PanelState& state);
void comparisonStatus(Comparison& comparison);

}  // namespace nacre
