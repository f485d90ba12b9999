// Virtual viewpoints: what a mirror or a refracting face shows, as a matrix from the world into the picture.
//
// A view is a projection from one point, its eye, whatever lies on the way. Behind a face with the plane π it is made
// of the view before, M, and a new eye E (homogeneous): each world point x is first projected from E onto the face,
//   S x = x − (π·x / π·E) E,
// and M takes the point of the face to the picture, so that the face's image fits by construction. For a mirror E is
// the reflected eye and M S shows the same as M times the reflection, which is what is used. For refraction it is
// PR94's quadrilateral-to-quadrilateral map (projective_map.hpp) without its four corners.
// M S has no depth left (S has rank 3). Its row of w has the depth of the point of the face times |x − E| / |S x − E|,
// which grows along each line of sight: z = A w + B, as in any perspective, is the depth that orders points right.
#pragma once

#include <optional>
#include <vector>

#include "core/scene.hpp"
#include "shading/multipass/placed_image.hpp"
#include "shading/multipass/specular_options.hpp"

namespace nacre {

/// (n, d): n·x + d is the distance of a point in front, n unit.
using Plane = Vec4;

/// How a path goes on from a face.
enum class Bounce { Reflected, Refracted };

struct SpecularView {
    glm::dmat4 toClip{1};
    Vec4 eye{0, 0, 0, 1};       ///< w = 1: position; w = 0: unit direction towards an orthographic viewer
    std::optional<Plane> clip;  ///< what lies in front of it is seen
    bool mirrored = false;      ///< outlines turn the other way
};

/// What becomes of the light that a view draws.
struct ViewLight {
    Rgb factor{1};
    Rgb fog{0};                          ///< what it fades to …
    double fogDistance = 0;              ///< … at this distance from the clip plane; 0: no fog
    std::vector<PlacedImage> filters{};  ///< and what it is multiplied by; at most kMostFilters
};

SpecularView viewOf(const Camera& camera, double aspect);

/// The side of a plane that the eye is on: 1, −1, or 0 where it sees no more than the plane's edge.
int sideOf(const SpecularView& view, const Plane& plane);

/// What the plane mirrors. The row of depth is stale: setDepths. \pre sideOf isn't 0
SpecularView reflected(const SpecularView& view, const Plane& plane);

/// What is seen through the plane from the eye that refractedEye found. The row of depth is stale: setDepths.
SpecularView refracted(const SpecularView& view, const Plane& plane, const Vec4& eye);

/// Either from an eye of the caller's: `kept`, 1 or −1, is the side of the plane that is seen. The row of depth is
/// stale.
SpecularView seenFrom(const SpecularView& view, const Plane& plane, const Vec4& eye, int kept, bool mirrored);

/// Unit, from a point to the eye.
Vec3 towardsEye(const SpecularView& view, const Vec3& point);

/// The first axis of a plane's own frame, unit; the second is the normal × it.
Vec3 planeAxis(const Plane& plane);

/// MPR's shear about the face's normal, which moves each point along the plane by `slope` times its distance: the same
/// as to move the eye the other way. \param slope  in the plane's own frame
Vec4 shearedEye(const Vec4& eye, const Plane& plane, const Vec2& slope);

/// The eye that refraction at `point` of the plane moves the view's eye to; none where all is reflected: sin θ ≥ the
/// index beyond. Snell: sin θ = η sin θ'. OnNormal: the distance to the plane becomes e tanθ / tanθ' = e η cosθ'/cosθ.
/// \param eta  the index beyond the plane over that on the eye's side, > 0
std::optional<Vec4> refractedEye(const SpecularView& view, const Plane& plane, const Vec3& point, double eta,
                                 RefractedEye how);

/// Sets the row of depth: −1 at `near`, 1 at `far`, of depthOf. \pre 0 < near < far, or near < far if orthographic
void setDepths(SpecularView& view, double near, double far);
/// No depth at all (PR94, equation A5).
void flattenDepths(SpecularView& view);
/// The clip w of a point; of an orthographic view the distance from the plane through the origin that faces the eye.
double depthOf(const SpecularView& view, const Vec3& point);

/// The point of the plane that is seen at a place of the picture (−1 to 1); none where the plane isn't before the eye.
std::optional<Vec3> planePointAt(const SpecularView& view, const Plane& plane, const Vec2& place);

/// Cosine of the angle at which the view's ray meets the plane in `point`; ≥ 0.
double incidentCosine(const SpecularView& view, const Plane& plane, const Vec3& point);

}  // namespace nacre
