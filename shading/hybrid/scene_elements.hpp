// A scene's surfaces as elements of nearly equal area: what reflects light once (HYBRID section 3). No OpenGL in here.
#pragma once

#include <span>
#include <vector>

#include "core/scene_description.hpp"
#include "core/shadow_view.hpp"

namespace nacre {

struct SceneElement {
    Vec3 centre{0}, normal{0};  ///< in the world; unit, to where its triangle is counter-clockwise
    double area = 0;
    Rgb albedo{0};
    std::size_t node = 0;
};

struct SceneElements {
    std::vector<glm::vec3> corners;  ///< three an element, in the world
    std::vector<SceneElement> elements;
    Bounds bounds;
};

struct ElementOptions {
    int least = 4096;  ///< elements that a scene with an area gets at least, and at most twice that many more than its
                       ///< triangles
    int bits = 24;     ///< of an item buffer: 2^bits − 1 elements have numbers
};

/// Each triangle is halved across its longest edge until no part is larger than the scene's area / options.least.
/// Triangles without area are left out. \param nodes  nodeTransforms' result; albedos: one a material
/// \throws std::invalid_argument for another number of albedos, an albedo outside [0, 1], least < 1, bits outside 1 …
/// 32;
///         nacre::Error "item buffer: expected at most …" for more elements than bits tell apart, and for volumes
SceneElements sceneElements(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                            std::span<const Rgb> albedos, const ElementOptions& options = {});

}  // namespace nacre
