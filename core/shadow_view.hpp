// How a light's depth map lies in the world, and what it says of a point: the values and formulas that
// shading/shadow_map.hpp draws and shaders/nacre/shadow.glsl looks up, in double precision.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/image.hpp"
#include "core/scene_description.hpp"

namespace nacre {

/// Axis-aligned box; empty (low > high) until something is added.
struct Bounds {
    Vec3 low{1e300}, high{-1e300};
    bool empty() const { return !(low.x <= high.x); }
    void add(const Vec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
    void add(const Bounds& b) { low = glm::min(low, b.low), high = glm::max(high, b.high); }
};
/// Of the mesh's vertices, moved.
Bounds boundsOf(const Mesh& mesh, const glm::dmat4& toWorld = glm::dmat4(1));

/// A stored depth d ≥ 1 says that nothing is there, and counts as this one: no receiver's plane is behind it.
inline constexpr double kShadowNothing = 1e6;

/// One layer each: Spot. Six, ±X ±Y ±Z of the world about the light: Cube. The hemispheres about −y and +y:
/// DualParaboloid (Brabec, Annen, Seidel 2002). One a cascade: Directional.
enum class ShadowKind { Spot, Directional, Cube, DualParaboloid };

/// A layer is size × size texels of linear depth d = (z − near)/(far − near), 1 where nothing is. z is the distance
/// along the layer's axis (DualParaboloid: from the light), so that the value is uniform in resolution and a plane's
/// depth needs no division by its resolution. Light space: x, y along the map, z away from the light; what
/// `fromWorld` gives is Cube's and DualParaboloid's world turned so that the first layer looks along its z.
struct ShadowView {
    ShadowKind kind = ShadowKind::Spot;
    int size = 1024;  ///< texels along an edge
    int bits = 32;    ///< of a stored depth, 16 or 32
    int filter = 3;   ///< texels along the filter's edge; their box is filter − 1 texels wide (1: one texel)
    glm::dmat4 fromWorld{1};
    double near = 0, far = 1;    ///< [world units]
    double scale = 1;            ///< Spot, Cube: map coordinate in [-1, 1] of x/z = 1; DualParaboloid: of the horizon
    std::vector<Vec3> cascades;  ///< Directional: map coordinate = (x, y) of .z· + .xy; finest first
    double resolution = 0;       ///< what a stored depth is off by [world units]
    std::optional<double> bias;  ///< the user's [world units]

    int layers() const;
};

/// The view of a light's map onto everything in `scene`, casters and receivers.
/// Spot: the cone with a margin of the filter. A wide cone (outer > 1.25 rad) and a point light: Cube or
/// DualParaboloid. Directional: the square that holds the box; with cascades > 1, squares about the camera's depth
/// ranges, ranges from near to the box's farthest point in steps halfway between equal and equal ratios, moved by whole
/// texels. near, far not given: those of the box; near of a point light is at least far / 1e5. \param camera  of the
/// cascades; may be null for one. \param aspect  width / height of its picture \throws std::invalid_argument: size < 8
/// or odd, bits other than 16 and 32, filter outside 1..9, cascades outside 1..4 or
///         above 1 without camera, bias < 0, near and far not 0 ≤ near < far, an empty box, a broken light
ShadowView fitShadow(const SceneShadow& options, const Light& light, const Bounds& scene,
                     const Camera* camera = nullptr, double aspect = 1);

/// Moves light space so that layer `layer` looks along z: a rotation of fromWorld's result; 1 but for Cube and
/// DualParaboloid's second.
Mat3 shadowLayerFrame(const ShadowView& view, int layer);

/// OpenGL clip space of a layer's light space (shadowLayerFrame · fromWorld). Not for DualParaboloid.
glm::dmat4 shadowClip(const ShadowView& view, int layer);

/// A point as the map sees it. Twins: nacre_shadow_place_… (shaders/nacre/shadow.glsl).
struct ShadowPlace {
    bool inside = false;  ///< the map says something about the point
    int layer = 0;
    Vec3 q{0};     ///< in the layer's light space
    Vec2 map{0};   ///< map coordinate in [-1, 1]
    double texel;  ///< edge of a texel at the point's depth [world units]
};
ShadowPlace shadowPlace(const ShadowView& view, const Vec3& position);

/// How far above the receiver's plane a stored surface must be to shadow it [world units].
///
/// The filter's n² texels reach h = n/√2 texels from the point. Let θ be the angle between the plane's normal and the
/// light's ray. A surface point at or beyond the receiver's depth, at most h aside, stands at most h sinθ over the
/// receiver's plane: with that bias nothing that is no nearer to the light shadows, be the surfaces flat, bent inwards
/// or stepped. sinθ ≤ (1 + sin²θ)/2 = 1 − cos²θ/2 needs no root; equal at θ = 90°, it leaves h/2 where the light is
/// above, for the facets of curved surfaces, which turn against each other (there by up to 35° within the filter).
/// To it comes what a stored depth is off by.
double shadowBias(const ShadowView& view, double texel, double cosTheta);

/// Share of the light that reaches a point of a surface with geometric normal `normal` (unit, on the side that is
/// looked at): percentage-closer filtering (Reeves 1987) where each texel's stored surface point is compared with the
/// receiver's plane, raised by shadowBias. 0 where the light is behind that side, 1 where the map says nothing.
/// \param layers  one image a layer, row 0 at map coordinate y = −1, normalised depths.
/// Twin: nacre_shadow_lit (shaders/nacre/bind/shadows.glsl), to one texel's weight
/// (tests/shading/shadow_map_test.cpp). \throws std::invalid_argument unless there is an image for each layer
double shadowLit(const ShadowView& view, std::span<const Image> layers, const Vec3& position, const Vec3& normal);

}  // namespace nacre
