// Shadow maps of virtual lights: a paraboloid each, as they light a hemisphere alone.
#pragma once

#include "shading/hybrid/item_buffer.hpp"
#include "shading/hybrid/virtual_lights.hpp"

namespace nacre {

/// Columns x, y and the normal, orthonormal (Duff et al. 2017). Twin: nacre_virtual_frame.
Mat3 virtualLightFrame(const Vec3& normal);

/// One array texture of 32-bit linear depth, a layer a light: 4 size² bytes each. Drawn by shadow_map.*.glsl, which
/// find the depth of each texel's ray in a triangle's plane, from a little above the light's place, so that its own
/// surface is behind. Looked up without filter: many lights blur each other's edges.
class VirtualShadows {
public:
    /// \throws std::invalid_argument unless size ≥ 8
    explicit VirtualShadows(int size = 128);

    /// Everything blocks, from both sides. Leaves framebuffer 0 bound, depth test and write on.
    void draw(ProgramLoader& loader, const GpuElements& gpu, const Bounds& bounds,
              std::span<const VirtualPointLight> lights);
    double lift() const { return lift_; }  ///< of the eye above the light [world units]
    /// nacre_virtual_maps and nacre_virtual_drawn. Leaves `program` in use.
    void bind(const Program& program, int unit) const;

private:
    int size_;
    std::size_t layers_ = 0;
    double lift_ = 0;
    glm::vec4 drawn_{0};
    TextureName texture_;
    FramebufferName framebuffer_;
};

}  // namespace nacre
