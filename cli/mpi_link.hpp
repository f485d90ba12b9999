// MPI's ranks as pipes.
#pragma once

#include <memory>

#include "shading/hybrid/pipe_link.hpp"

namespace nacre::cli {

/// Starts MPI, and ends it when the link goes. Ranks of one machine share its cores as rasterizer threads. MPI itself
/// ends all ranks when one of them dies; one that is late is left out.
/// \throws nacre::Error where this command was built without MPI, or the MPI has no threads
std::unique_ptr<PipeLink> mpiLink();

}  // namespace nacre::cli
