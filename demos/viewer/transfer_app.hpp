// The viewer of moving meshes in light that turns: its window, what events do, and when it draws.
#pragma once

#include "demos/viewer/options.hpp"

namespace nacre {

/// Runs until the window is closed, or the benchmark is done.
/// \throws nacre::Error: no display, no OpenGL 3.3, a lost context, what can't be read
void runTransferViewer(const ViewerOptions& options);

}  // namespace nacre
