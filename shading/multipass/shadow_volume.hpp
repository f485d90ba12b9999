// Shadow volumes (Crow 1977; MPR section 4.1) of any mesh, as lists of its points: no view is in them, and a mirror's
// image of one is the same lists under the mirror's matrix (MPR section 4.3).
#pragma once

#include <span>

#include "core/shadow_view.hpp"
#include "shading/multipass/shadow_mesh.hpp"

namespace nacre {

/// A light as a homogeneous point: its position and 1, or the unit direction towards it and 0.
Vec4 homogeneous(const Light& light);

/// What one object's triangles keep from one light. Each triangle is turned to face the light and swept away from it to
/// infinity; the sum of these bodies contains a point as often as triangles stand between it and the light. Sides of
/// neighbouring triangles cancel (plus-minus counting), which leaves:
///   sides  from each edge, away from the light, as often as the triangles at it don't cancel: once at a silhouette or
///          a border, twice where two triangles fold over it;
///   caps   the triangles, and the same at infinity. A light at infinity has one vanishing point and no far cap.
///          They are named as runs of the mesh's own list, which all its volumes share.
/// A solid (ShadowMesh::solid) that the light is outside of needs the triangles that face the light alone: what enters
/// it goes through one of them first, or begins inside. Any other mesh takes all of its triangles.
///
/// Point 2 i is positions[i], point 2 i + 1 the same swept to infinity. Sides go counter-clockwise seen from outside.
struct ShadowVolume {
    struct Sides {
        std::uint32_t first = 0, count = 0;  ///< of `indices`
        int times = 1;                       ///< how often they count
    };
    struct Run {
        std::uint32_t first = 0, count = 0;  ///< of triangles
    };
    struct Caps {
        std::vector<Run> facing, turned;  ///< counter-clockwise and clockwise, seen from the light
        std::size_t triangles() const;
    };
    std::vector<std::uint32_t> indices;  ///< of sides, three points a triangle
    std::vector<Sides> sides;            ///< at most a few
    Caps caps;
    bool farCap = true;
    bool cut = false;  ///< near caps are whole triangles of the mesh, far caps pieces
    Caps farCaps;      ///< of a cut mesh: of its pieces

    bool empty() const { return indices.empty() && mostLayers() == 0; }
    std::size_t bytes() const;
    /// Triangles that can stand one behind the other: no count is higher.
    std::size_t mostLayers() const { return caps.triangles(); }
};

/// \param light  in the world, homogeneous. O(triangles), with a light inside the body's box some 10 times that.
/// \throws std::invalid_argument unless toWorld and light are finite
ShadowVolume makeShadowVolume(const ShadowMesh& mesh, const glm::dmat4& toWorld, const Vec4& light);

/// The same of what of the mesh lies in front of planes. Near caps are its whole triangles, to be drawn where they are
/// in front of the planes alone: a pixel of the mesh then finds its own triangle at its own depth, which a piece of it
/// might miss by rounding.
ShadowVolume makeShadowVolume(const ShadowMesh& mesh, const CutShadowMesh& cut, const glm::dmat4& toWorld,
                              const Vec4& light);

/// Bytes of the same encoding with a volume for each polygon: three sides each. Its caps are the mesh's own triangle,
/// which isn't stored again.
std::size_t bytesOfVolumeAPolygon(const ShadowMesh& mesh, const Vec4& light);

/// Whether no point of `window` is in the shadow of what is in `casters`, proved by a plane between both and the light.
/// With the window that a view looks through (a camera's near rectangle, a mirror's face), each side that hides a
/// point behind it from the eye is then crossed beyond it, and z-pass counting needs no caps. False may be wrong, true
/// never. \param window  corners, convex, flat
bool windowIsLit(std::span<const Vec3> window, const Bounds& casters, const Vec4& light);

/// Corners of what is on the near plane of a view, in turn. \param clipToWorld  inverse of projection · view
std::vector<Vec3> nearWindow(const glm::dmat4& clipToWorld);

}  // namespace nacre
