// What shadow volumes are swept from.
#pragma once

#include <vector>

#include "core/scene.hpp"
#include "shading/multipass/specular_view.hpp"

namespace nacre {

/// A light, or its image by way of specular faces (virtual_light.hpp).
struct ShadowSource {
    Vec4 light{0};                     ///< homogeneous, in the world
    std::vector<int> name{};           ///< the same in each frame: who shines, by which faces
    glm::dmat4 toLast{1};              ///< takes volumes to where they are seen
    std::vector<Plane> within{};       ///< of objects, what is in front of these alone casts; at most kMostCuts
    std::vector<std::size_t> faces{};  ///< nodes in those planes, one each: they don't cast
};

}  // namespace nacre
