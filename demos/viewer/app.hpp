// The viewer: its window, what events do, and when it draws.
#pragma once

#include "demos/viewer/options.hpp"
#include "demos/viewer/reference_job.hpp"

namespace nacre {

/// Runs until the window is closed, or the benchmark is done. It draws when something has changed and waits otherwise.
/// \throws nacre::Error: no display, no OpenGL 3.3, a scene that can't be read
void runViewer(const ViewerOptions& options, const ReferenceTracer& tracer);

}  // namespace nacre
