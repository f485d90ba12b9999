// Place, normal and albedo of what each pixel of a view shows: drawn once, read by every pass of many lights. Its tags
// are the item buffer from the eye (HYBRID section 4.3).
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/scene_description.hpp"
#include "shading/gpu_mesh.hpp"
#include "shading/program.hpp"

namespace nacre {

/// What a pixel shows. All of a view's pixels, row 0 lowest.
struct SeenPoint {
    glm::vec4 place;   ///< in the world; w: the node's index + 1, 0 where nothing is
    glm::vec4 normal;  ///< unit, interpolated; w: 1 on specular surfaces
};

/// Textures of 32-bit floats, 48 bytes a pixel and depth. A context must be current for all calls.
class GeometryBuffer {
public:
    /// \throws nacre::Error when the driver refuses
    GeometryBuffer(int width, int height);
    int width() const { return width_; }
    int height() const { return height_; }

    /// Draws every node with a mesh. \param meshes  by the scene's index, kept between calls; albedos: one a material;
    ///        nodes: nodeTransforms' result. Leaves framebuffer 0 bound, depth test and write on.
    void draw(ProgramLoader& loader, const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
              std::span<const Rgb> albedos, std::map<int, GpuMesh>& meshes) {
        draw(loader, scene, nodes, albedos, meshes, scene.camera);
    }
    void draw(ProgramLoader& loader, const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
              std::span<const Rgb> albedos, std::map<int, GpuMesh>& meshes, const Camera& camera);
    std::vector<SeenPoint> read() const;
    GlName depthBuffer() const { return depth_.name(); }  ///< a renderbuffer of 24 bits, and 8 of stencil
    /// Sets the uniforms of bind/geometry.glsl and leaves `program` in use: units 0 to 2.
    void bind(const Program& program) const;

private:
    int width_, height_;
    FramebufferName framebuffer_;
    TextureName place_, normal_, albedo_;
    Renderbuffer depth_;
};

}  // namespace nacre
