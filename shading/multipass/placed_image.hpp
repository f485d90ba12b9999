// What a place of the world takes of a specular face's picture (face_image.hpp makes it).
#pragma once

#include "core/math.hpp"

namespace nacre {

struct PlacedImage {
    glm::dmat4 place{1};   ///< of (x, 1) to (u w, v w, w, h)
    glm::vec4 rect{0};     ///< of the scene's faceImages; 0: none
    bool filters = false;  ///< rgb are factors
    double surface = 0;    ///< times alpha: what isn't sent on
};

}  // namespace nacre
