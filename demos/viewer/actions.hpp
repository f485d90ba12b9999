// What the keys do.
#pragma once

#include "demos/viewer/comparison.hpp"
#include "demos/viewer/key_map.hpp"
#include "demos/viewer/panel.hpp"

namespace nacre {

void act(Action action, ViewerSession& session, Comparison& comparison, PanelState& state);

}  // namespace nacre
