// The way back from the eye past mirrors and panes: one ray becomes those that bring its light. Nothing of shading/.
#pragma once

#include <functional>

#include "core/scene_description.hpp"
#include "reference/scene_rays.hpp"

namespace nacre {

/// Reflectance of unpolarised light from Fresnel's amplitudes, given both cosines; eta: index beyond over before.
double fresnelReflectance(double before, double beyond, double eta);

/// What leaves a specular surface towards the viewer: where it came from and what share arrives, its factor included.
struct SpecularRay {
    Vec3 direction;  ///< unit
    Rgb share{0};
};

/// Exact for each ray: mirror direction, Snell, Fresnel from amplitudes. Radiance isn't scaled by the squared index, as
/// no pass of shading/ does. \param along  unit, of the ray that met the surface; normal: unit, of the front
/// \return  none to two, without shares of 0
std::vector<SpecularRay> specularRays(const SceneSpecular& surface, const Vec3& along, const Vec3& normal);

/// End of a path: on a surface, or where nothing is hit.
struct PathEnd {
    std::optional<SceneRays::Hit> hit;
    Vec3 direction;         ///< unit, of the last ray
    Rgb share{1};           ///< of its light that reaches the eye
    Rgb texel{1};           ///< factor of a specular surface's own light
    bool specular = false;  ///< the ray's first surface is specular
};

struct SpecularPathOptions {
    int depth = 4;       ///< specular surfaces along a path
    int spreadRays = 1;  ///< of the first frosted or glossy one; one of each further one
    /// Independent points of the unit square; needed where something spreads.
    std::function<Vec2()> next{};
};

/// Follows a ray over at most options.depth specular surfaces. Calls `end` once for each end; a specular surface's own
/// light (SceneSpecular::surface) is one of them. \return what fog adds: radiance, not of any end
Rgb followSpecular(const SceneDescription& scene, const SceneRays& rays, const Ray& ray,
                   const SpecularPathOptions& options, const std::function<void(const PathEnd&)>& end);

}  // namespace nacre
