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

/// The same motion at another rate: linear between frames, from the first for as long as there are frames.
/// \throws std::invalid_argument for a rate that isn't finite and > 0; nacre::Error naming the mesh for more than
/// 100000
///         frames, or as checkAnimation
AnimatedMesh resampled(const AnimatedMesh& animation, double framesPerSecond, const std::string& name);

/// A body that moves as a whole.
struct MovingBody {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> uvs;  ///< one a vertex, or none
    std::vector<glm::uvec3> triangles;
    std::vector<glm::dmat4> frames;  ///< to world coordinates; determinant > 0, so that triangles keep their sides
};

/// Bodies that move by themselves as one mesh, in the order given.
/// \throws std::invalid_argument when bodies differ in their number of frames, or a matrix mirrors or isn't finite;
///         nacre::Error naming the mesh as checkAnimation
AnimatedMesh rigidAnimation(const std::vector<MovingBody>& bodies, double framesPerSecond, const std::string& name);

}  // namespace nacre
