// Meshes that move: what animated files, simulations and moving bodies become, whatever made them.
#pragma once

#include <string>
#include <vector>

#include "core/scene.hpp"

namespace nacre {

/// One topology, positions for every frame. Positions may be non-finite in a frame: who computes on the frame refuses
/// it by its number, and the others go on.
struct AnimatedMesh {
    std::vector<glm::uvec3> triangles;           ///< counter-clockwise seen from outside
    std::vector<glm::vec2> uvs;                  ///< one a vertex, or none
    std::vector<std::vector<glm::vec3>> frames;  ///< [frame][vertex], all of one length [world units]
    double framesPerSecond = 30;

    std::size_t vertexCount() const { return frames.empty() ? 0 : frames.front().size(); }
};

/// \throws nacre::Error naming the frame: no frame, frames of different length ("topology changes"), indices out of
///         range
void checkAnimation(const AnimatedMesh& animation, const std::string& name);

}  // namespace nacre
