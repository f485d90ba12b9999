// Draws shadow volumes into the stencil buffer: plus-minus counting of a view's visible points.
#pragma once

#include <array>

#include "shading/gl_objects.hpp"
#include "shading/multipass/shadow_volume.hpp"
#include "shading/multipass/specular_view.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"

namespace nacre {

/// A mesh's points, each twice (ShadowVolume), and its triangles. 32 bytes a point, 12 a triangle.
class GpuShadowPoints {
public:
    /// Leaves array buffer 0 bound. \throws std::invalid_argument without points
    explicit GpuShadowPoints(const ShadowMesh& mesh);
    std::size_t bytes() const { return bytes_; }

private:
    friend class GpuShadowVolume;
    VertexArray array_;  ///< of the triangles
    Buffer buffer_, triangles_;
    std::size_t bytes_ = 0;
};

/// A volume's lists; its caps are drawn as runs of the points' triangles. Move-only.
class GpuShadowVolume {
public:
    /// \param points  of the mesh that the volume was made of; outlives this
    /// \param pieces  of a cut mesh the points of its pieces; outlives this
    GpuShadowVolume(const GpuShadowPoints& points, const ShadowVolume& volume, const GpuShadowPoints* pieces = nullptr);
    std::size_t bytes() const { return bytes_; }
    const ShadowVolume& shape() const { return shape_; }  ///< without its indices

    // Under a program of stencil_volume.vert.glsl. Leave a vertex array bound.
    void drawSides() const;
    /// Sets the front face so that faces seen from outside the volume are front ones. \param mirrored  in a mirror
    void drawCaps(bool far, bool mirrored) const;

private:
    VertexArray array_;
    Buffer indices_;
    const GpuShadowPoints* points_;
    const GpuShadowPoints* farPoints_;
    ShadowVolume shape_;
    std::size_t bytes_ = 0;
};

/// One volume in the world.
struct PlacedShadowVolume {
    const GpuShadowVolume* volume = nullptr;
    glm::dmat4 toWorld{1};  ///< of the object, or of its image
    Bounds box;             ///< of the object there, in the world
    std::size_t mostLayers = 0;
    bool image = false;         ///< not the object itself: its near caps aren't drawn surfaces
    bool mirrored = false;      ///< outlines turn the other way
    std::vector<Plane> cuts{};  ///< of a volume of a cut mesh: in the mesh's space, at most kMostCuts
};

inline constexpr std::size_t kMostCuts = 2;

/// What is looked through. A mirror's image is seen with its matrix in worldToClip and `mirrored` set; the window then
/// is the mirror's face, carried to the same side as the objects.
struct ShadowSight {
    glm::dmat4 worldToClip{1};
    bool mirrored = false;
    std::vector<Vec3> window{};   ///< in the world; empty: never z-pass
    std::optional<Plane> clip{};  ///< what lies in front of it alone was drawn

    static ShadowSight of(const Camera& camera, double aspect);
    static ShadowSight of(const SpecularView& view);  ///< a virtual viewpoint
};

/// Which way of counting, for measurements; Auto is always right.
enum class ShadowCounting { Auto, ZFail, ZPass };

/// Counts one light's volumes in the stencil of a target whose depth buffer holds the view:
/// begin, volumes, what is drawn under lit() — pixels that no volume contains —, end.
/// Between begin and end the view's pixels have SHAD_MIN's bit (stencil_counter.hpp), and counts are modulo 128 in the
/// bits below, so that the order of volumes and faces doesn't matter.
/// Needs desktop OpenGL (depth clamp). \throws nacre::Error on OpenGL ES
class ShadowStencil {
public:
    explicit ShadowStencil(ProgramLoader& loader);

    /// Pixels of the view become SHAD_ZERO. \param level  the value that they have: of the view's recursion
    void begin(const RenderTarget& target, int level = 0);
    /// Volumes whose layers might pass 127 together are settled in between: pixels in shadow leave the count for good.
    /// Of one object alone, and in views of a level above 0, 128 layers one behind the other along a ray, no fewer and
    /// no more, would be missed. With `levels` nothing is settled: counts of several lights add up, to 63 at most.
    /// \param light  homogeneous, in the world
    void count(const RenderTarget& target, std::span<const PlacedShadowVolume> volumes, const Vec4& light,
               const ShadowSight& sight, ShadowCounting counting = ShadowCounting::Auto, bool levels = false);
    /// Of a light volume: pixels that no volume of a face contains leave the count, the others have none again (MPR
    /// section 4.2). Before other volumes are counted.
    void narrow(const RenderTarget& target, const PlacedShadowVolume& face, const Vec4& light,
                const ShadowSight& sight);
    /// Draws from here on pass where the count is `count`, once a pixel, which then has its level again. Colours and
    /// depth are written again. \throws std::invalid_argument for a count in views of a level above 0
    void lit(unsigned count = 0);
    /// Every pixel of the count has its level again; stencil test off.
    void end(const RenderTarget& target);

    int settled() const { return settled_; }  ///< since begin
    int zPasses() const { return zPasses_; }  ///< volumes counted that way since begin
    int zFails() const { return zFails_; }

private:
    unsigned valueOf(unsigned count) const;
    void settle(const RenderTarget& target);
    void everywhere(unsigned reference, unsigned mask, unsigned op, unsigned writes) const;
    void place(unsigned kind, const PlacedShadowVolume& placed, const Vec4& light, const ShadowSight& sight);
    void drawZPass(const PlacedShadowVolume& placed, const Vec4& light, const ShadowSight& sight);
    void drawZFail(const PlacedShadowVolume& placed, const Vec4& light, const ShadowSight& sight);
    ProgramLoader* loader_;
    const Program& fill_;
    std::array<const Program*, 8> volumes_{};  ///< by kind, when loaded
    VertexArray empty_;
    unsigned level_ = 0;
    std::size_t layers_ = 0;
    int settled_ = 0, zPasses_ = 0, zFails_ = 0;
};

}  // namespace nacre
