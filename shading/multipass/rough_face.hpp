// What the facets of a rough mirror or pane do to a view: each of them one shear of it.
#pragma once

#include "core/math.hpp"
#include "shading/multipass/specular_view.hpp"

namespace nacre {

struct FacetShear {
    Vec2 slope{0};      ///< for shearedEye
    double weight = 0;  ///< of the facet's light; 0: it sends none this way
    Vec3 facet{0};      ///< its normal, unit
};

/// Sample i of two independent standard Gaussians (Box and Muller's).
Vec2 facetSample(int i, ShearSampling sampling);

/// A facet of Beckmann's distribution (Walter et al. 2007) as the ray that meets the face towards the eye sees it. The
/// ray's new direction is exact; that all rays of the view are off by the same slope is MPR's approximation (section
/// 3). \param towardsEye  unit, on the side of the plane that the ray comes from \param eta  beyond over before; none:
/// the facet mirrors \param alpha  Beckmann's width \param gaussian  of the facet's slopes: two standard Gaussians
FacetShear facetShear(const Vec3& towardsEye, const Plane& plane, const std::optional<double>& eta, double alpha,
                      const Vec2& gaussian);

}  // namespace nacre
