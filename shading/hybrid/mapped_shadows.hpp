// Soft shadows by a shadow map for each point of a light's area: the alternative to counted volumes (HYBRID
// sections 1.1 and 4.1).
#pragma once

#include <span>

#include "core/shadow_view.hpp"
#include "shading/hybrid/shadow_levels.hpp"

namespace nacre {

struct MappedShadowOptions {
    int size = 512;  ///< texels along the edge of a map's six faces, 8 to 1024; fewer where the driver takes no more
    double offset = 0.5;  ///< receivers are moved along their normals by so many texels
};

/// For one scene as it stands. The maps of all points stand in one texture, a row a point and a column a face of the
/// cube around it, so that one framebuffer takes them all; faces that no pixel of the view can look up aren't drawn,
/// and of casters only the triangles that a face may see from one of the points. A pixel looks up every point's map
/// once, without filter: the filter is over the levels. Everything casts from both sides. 24 size² bytes a point.
class MappedShadows {
public:
    static constexpr int kMostPoints = 64;

    /// \param nodes  nodeTransforms' result; nodes with a mesh that cast shadows
    MappedShadows(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes);

    /// Adds an equal share of 1 for each point that doesn't reach a pixel's surface. Leaves framebuffer 0 bound.
    /// \param points  of one light, none directional. \param geometry  drawn with `camera`, the size of `levels`
    /// \throws std::invalid_argument: no points or too many, a directional one, sizes; nacre::Error from the driver
    void add(ProgramLoader& loader, const GeometryBuffer& geometry, const Camera& camera, std::span<const Light> points,
             ShadowLevels& levels, const MappedShadowOptions& options = {});

    /// Of the last add: triangles drawn, all points and faces together.
    std::size_t trianglesDrawn() const { return drawn_; }

private:
    struct Face;
    std::vector<Face> facesOf(std::span<const Light> points, const Camera& camera, double aspect) const;
    void allocate(int width, int height);

    std::vector<glm::vec3> positions_;  ///< of all casters, in the world
    std::vector<glm::uvec3> triangles_;
    Bounds bounds_;
    std::size_t drawn_ = 0;
    int width_ = 0, height_ = 0;  ///< of the texture
    std::optional<TextureName> maps_;
    FramebufferName framebuffer_;
    VertexArray array_;
    Buffer points_, indices_;
};

}  // namespace nacre
