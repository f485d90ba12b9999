// A moving mesh whose vertices have their exitant radiance, computed elsewhere (HEMI section 3, "Rendering").
#pragma once

#include <cstdint>
#include <span>

#include "core/scene.hpp"
#include "shading/gl_objects.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"

namespace nacre {

/// Positions and radiance of one frame on the GPU. Attributes 0 position, 1 radiance.
class GpuVertexLight {
public:
    /// \param triangles  of the mesh's vertices \param weldOf  each vertex's number among the welded ones
    ///        (transfer/surface.hpp), which positions and radiance are given for
    /// \throws std::invalid_argument without triangles, or when one has a vertex that isn't in weldOf
    GpuVertexLight(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> weldOf);

    /// The next frame: 24 bytes a welded vertex are uploaded. \param radiance  linear, of any sign
    /// \throws std::invalid_argument unless there are as many of each as welded vertices
    void update(std::span<const glm::vec3> positions, std::span<const glm::vec3> radiance);

    /// Draws every triangle with the program in use. Leaves vertex array 0 bound.
    /// \throws std::invalid_argument before the first update
    void draw() const;

private:
    VertexArray array_;
    Buffer positions_, radiance_, indices_;
    std::size_t vertices_ = 0;
    int indexCount_ = 0;
    bool filled_ = false;
};

/// Draws the radiance, interpolated over each triangle, into `target`; back faces are black, as in lit_pass.hpp.
/// Doesn't clear. Depth test and write on, face culling and blending off, left so, with the program in use. \throws
/// std::invalid_argument before the first update; nacre::Error from the shaders
void renderVertexLight(ProgramLoader& loader, const RenderTarget& target, const GpuVertexLight& mesh,
                       const Camera& camera);

}  // namespace nacre
