// Shadow volumes by s-count and g-count (HYBRID section 2), and soft shadows from binary images of a light's points.
#pragma once

#include "shading/hybrid/ray_scene.hpp"
#include "shading/hybrid/shadow_levels.hpp"
#include "shading/multipass/shadow_stencil.hpp"

namespace nacre {

/// None: volumes are open at both ends, and points before which a ray passes through an end are wrong (HYBRID figure
/// 5). Exact: all have both ends. Approximate: those of objects that rays from points of the view plane to the light
/// meet; of others nothing is in the g-count, as they are taken not to hold a point of the view plane.
enum class VolumeCapping { None, Exact, Approximate };

struct CountedShadowOptions {
    VolumeCapping capping = VolumeCapping::Exact;
    int planePoints = 16;  ///< Approximate: rays from the view plane, ≥ 1
};

/// For one view. Of each pixel's ray from the view plane (here the near plane) to the point that it shows:
///   s-count  sides entered minus sides left before that point: drawn with the depth test into a float's signed values
///   g-count  sides and ends left minus those entered along the whole ray, how many volumes hold the ray's start: drawn
///            at once with it, by a stencil that counts whether the depth test passes or not
/// The point is in shadow when their sum is above 0. Neither is clamped at 0, as HYBRID 2.1 has it: a ray that starts
/// in a volume and leaves it has s = −1, g = 1. HYBRID draws the end next to the light only when the light is before
/// the eye and the far one only when it is behind it; a slanted occluder breaks that rule, so Exact draws both. At most
/// 127 volumes hold a point of the view plane. Needs clip distances and depth clamp: desktop OpenGL.
class CountedShadows {
public:
    /// \param nodes  nodeTransforms' result; objects are nodes with a mesh that cast shadows
    CountedShadows(ProgramLoader& loader, const SceneDescription& scene, const std::vector<glm::dmat4>& nodes);

    /// Starts a new image of the buffer's size. \param geometry  drawn, outlives the next calls
    void begin(const GeometryBuffer& geometry, const Camera& camera);
    /// Adds `weight` where the light doesn't reach. \param light  homogeneous, in the world
    /// \throws std::invalid_argument before begin
    void add(const Vec4& light, double weight = 1, const CountedShadowOptions& options = {});
    /// What was added, one channel, row 0 on top.
    Image read(ShadowFilter filter = ShadowFilter::None);
    const ShadowLevels& levels() const;     ///< \throws std::invalid_argument before begin
    int capped() const { return capped_; }  ///< volumes with ends, in the last add

private:
    struct Object {
        ShadowMesh shape;  ///< in the world
        GpuShadowPoints points;
        std::size_t node = 0;
    };
    std::vector<bool> taggedNodes(const Vec4& light, int points) const;
    void draw(const Object& object, const Vec4& light, bool counted, bool caps);
    void addStencil();
    void allocate(const GeometryBuffer& geometry);

    ProgramLoader& loader_;
    std::vector<Object> objects_;
    RayScene rays_;
    std::size_t nodes_;
    const GeometryBuffer* geometry_ = nullptr;
    glm::dmat4 worldToClip_{1};
    int width_ = 0, height_ = 0, capped_ = 0;
    std::optional<LevelTarget> count_;
    std::optional<ShadowLevels> levels_;
};

}  // namespace nacre
