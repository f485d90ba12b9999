// Pixels of specular surfaces, traced on the CPU while the pipeline draws everything else (HYBRID section 4.3).
#pragma once

#include <span>

#include "core/image.hpp"
#include "factorize/reflectance.hpp"
#include "shading/hybrid/geometry_buffer.hpp"
#include "shading/hybrid/ray_scene.hpp"
#include "shading/hybrid/virtual_lights.hpp"

namespace nacre {

/// Where a path over specular surfaces ends, and what share of its light reaches the pixel.
struct TracedEnd {
    std::uint32_t pixel = 0;  ///< row 0 lowest
    bool hit = false;
    RaySceneHit at;
    Vec3 direction;  ///< unit, of the last ray
    Rgb share{1};
};

/// What lights an end that the eye doesn't see.
struct TracedLight {
    std::vector<Light> lamps;                     ///< points of areas one by one
    std::vector<bool> shadowed;                   ///< one a lamp
    std::span<const VirtualPointLight> virtuals;  ///< none: no indirect light
    bool virtualShadows = false;
    NearLight near = NearLight::Rectangle;
};

struct TracedReport {
    std::size_t pixels = 0, ends = 0;
    double reused = 0;  ///< share of the ends on surfaces that took the picture's light
};

/// Rays of a scene as it stands.
class SpecularTracer {
public:
    /// \param scene  outlives this \param brdfs  one a material, empty ones reflect nothing; those that are the same in
    ///        all directions are taken as diffuse
    /// \throws nacre::Error for specular surfaces that spread, have fog, a texture or a share of own light, for a
    ///         surrounding, a relief, a volume, or a map as background; nacre::Error when Embree fails
    SpecularTracer(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                   std::vector<BrdfFunction> brdfs);

    /// Paths from the tagged pixels of a view, which begin where the buffer says: a ray from just before that place
    /// finds its triangle. Exact mirror and refracted directions about interpolated normals, Fresnel, at most `depth`
    /// specular surfaces. No OpenGL: may run beside drawing. \param seen  of the scene's camera, width a row
    std::vector<TracedEnd> follow(std::span<const SeenPoint> seen, int width, int depth, unsigned threads = 0) const;

    /// Light of the tagged pixels, black elsewhere; three channels, row 0 on top. Ends on diffuse surfaces that the eye
    /// also sees, away from edges of shadows, take the picture's light; others have their own computed with shadow
    /// rays. \param picture  direct and indirect light of all but specular surfaces, row 0 on top, of the buffer's size
    Image shade(std::span<const TracedEnd> ends, std::span<const SeenPoint> seen, const Image& picture,
                const TracedLight& light, TracedReport* report = nullptr, unsigned threads = 0) const;

private:
    void followOne(std::uint32_t pixel, const RaySceneHit& at, const Vec3& along, const Rgb& share, int left,
                   std::vector<TracedEnd>& out) const;
    std::optional<Rgb> seenLight(const TracedEnd& end, std::span<const SeenPoint> seen, const Image& picture,
                                 const glm::dmat4& toClip) const;
    Rgb ownLight(const TracedEnd& end, const TracedLight& light) const;

    const SceneDescription& scene_;
    std::vector<BrdfFunction> brdfs_;
    std::vector<bool> diffuse_;  ///< a material
    RayScene rays_;
};

}  // namespace nacre
