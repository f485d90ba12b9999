// The mirrors and panes of a scene as polygons in the world.
#pragma once

#include <vector>

#include "core/scene_description.hpp"
#include "shading/multipass/face_image.hpp"
#include "shading/multipass/specular_view.hpp"

namespace nacre {

struct SpecularFace {
    std::size_t node = 0;       ///< of the scene
    Plane plane{0};             ///< the front is where the triangles are counter-clockwise
    std::vector<Vec3> outline;  ///< convex hull, counter-clockwise seen from the front; at least 3 points
    SceneSpecular specular;
    FaceImage image{};

    Vec3 centre() const;  ///< mean of the outline
};

/// One a node whose material is specular and whose mesh has an area. \param nodes  nodeTransforms' result
std::vector<SpecularFace> specularFaces(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes);

/// Whether SceneSpecular::filter is of what goes this way.
inline bool filtersLight(const SceneSpecular& s, Bounce how) { return !s.ior || how == Bounce::Refracted; }

bool hasSpecular(const SceneDescription& scene);  ///< a node with a specular material

/// \throws nacre::Error "node 'pane': expected a planar mesh for the specular material 'glass', found …", and for
///         volumes and uv that are no affine map of a face with a picture; std::invalid_argument for factors and
///         indices out of range
void checkSpecular(const SceneDescription& scene);
void checkPlanarFaces(const SceneDescription& scene);  ///< the first two of these

/// The polygon cut where a half space ends: `inside` is ≥ 0 in it, and linear. Empty when nothing is left.
template <class Point, class Inside>
std::vector<Point> clipped(const std::vector<Point>& polygon, const Inside& inside) {
    std::vector<Point> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = inside(a), db = inside(b);
        if (da >= 0) out.push_back(a);
        if ((da >= 0) != (db >= 0)) out.push_back(a + da / (da - db) * (b - a));
    }
    return out.size() < 3 ? std::vector<Point>() : out;
}

/// Twice the area, > 0 when counter-clockwise.
double twiceArea(const std::vector<Vec2>& polygon);

}  // namespace nacre
