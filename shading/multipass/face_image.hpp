// Pictures on specular faces as projective textures (MPR section 4.5): what they do to light that the faces send on,
// and to what is seen in them.
//
// A place x of the world takes the texel of a face's point through which it is lit, or seen. That point is x projected
// from the virtual light, or eye, E onto the face's plane π,
//   S x = x − (π·x / π·E) E,
// and its uv is affine in it: uv and a weight are linear in x, one matrix a face. On each plane that is lit, it is the
// paper's map of quadrilateral to rectangle; nothing has to be aligned with an axis. Of two faces, one after the other,
// the second's point is projected once more: again one matrix.
#pragma once

#include <vector>

#include "core/scene_description.hpp"
#include "shading/multipass/specular_view.hpp"

namespace nacre {

/// A face's picture.
struct FaceImage {
    glm::vec4 rect{0};  ///< of the scene's faceImages: x, y, width, height [texels]; 0 without
    Vec4 u{0}, v{0};    ///< uv of a point p of the face: u·(p, 1) and v·(p, 1)
    double off = 0;     ///< of the worst vertex from that
};

/// A face's uv, by its largest triangle. \param points  the mesh's, in the world
FaceImage faceImage(const std::vector<Vec3>& points, const Mesh& mesh);

/// Where each material's picture is; 0 where it has none. One below the other.
std::vector<glm::vec4> faceImageRects(const SceneDescription& scene);
/// All pictures in one of four channels: rgb of the filter, or 1; alpha of the texture, or 0. Empty where there is
/// none.
Image faceImages(const SceneDescription& scene);

/// Onto a plane, from an eye that isn't on it (homogeneous).
glm::dmat4 projectionFrom(const Vec4& eye, const Plane& plane);

/// \param onto  takes what is lit or seen to the point of the face
PlacedImage placedImage(const FaceImage& image, const glm::dmat4& onto);

}  // namespace nacre
