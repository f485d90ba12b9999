// Lights that mirrors and panes make: a light's way past faces as the place it seems to shine from (MPR section 4.2).
//
// A mirror reflects the light. A pane moves it along the normal, to where the ray through the middle of what it lights
// of the face seems to come from: that eye's rule (specular_view.hpp), with the light for the eye, exact for
// directions. Each face maps what was before it to what is after it so that light's straight ways stay: a reflection R,
// or for panes
//   B x = x + (π·x / π·V) (V' − V),
// which leaves the face π as it is and takes the light V to V'. Volumes of what stands before the face are then seen
// after it under B, which is how a stored volume is used again for its reflections (MPR section 4.3).
// Flux is kept where light meets the face: of a point's light, irradiance is I cosθ / (cosθ' l²) right behind it, l
// before and l' after B the distance to the light, which is that of an intensity of I (l'/l)² cosθ / cosθ' at V'. In
// the direction d to V' the way to V is B⁻¹ d, l/l' = |B⁻¹ d|, and cosθ / cosθ' = (π·V / π·V') / |B⁻¹ d|: a constant
// over |B⁻¹ d|³.
#pragma once

#include "core/scene_description.hpp"
#include "shading/multipass/specular_face.hpp"

namespace nacre {

struct LightBounce {
    int face = 0;  ///< of the scene's specular faces
    Bounce how{};
    bool operator==(const LightBounce&) const = default;
};

/// Light's way between two faces, or from the lamp, or to what it lights.
struct LightStage {
    Vec4 source{0};               ///< where the light seems to be here, homogeneous, in the world
    glm::dmat4 toLast{1};         ///< takes what is on this stage to where it seems to be after the last face
    std::vector<Plane> within;    ///< of objects, what lies in front of these may block
    std::vector<int> planeFaces;  ///< whose planes they are
};

/// Fresnel's share at a face, found a pixel at a time.
struct WeighedBounce {
    Mat3 turn{1};      ///< takes the direction to the virtual light to that to the light before the face
    Vec3 normal{0};    ///< of the face, or of a rough one's facet
    double index = 0;  ///< beyond over before; < 0: of what is reflected
};

struct VirtualLight {
    std::size_t light = 0, point = 0;  ///< of the scene, and of its area
    std::vector<LightBounce> bounces;  ///< none: the lamp itself
    int shear = -1;                    ///< which sample of a frosted or glossy face, the only one on the way
    std::vector<LightStage> stages;    ///< one more
    Light seen;  ///< at the last stage's source; its color has all factors but `weighed`, `images` and
                 ///< 1 / |toLamp d|³ in the direction d; its cone is the lamp's own
    std::vector<WeighedBounce> weighed;
    /// Of the faces' pictures and fog, the last face first; none where no face has any. Row h of a place over the w of
    /// the entry before, of the first over 1, is what share fog takes behind the face.
    std::vector<PlacedImage> images;
    Mat3 toLamp{1};  ///< takes the direction to it to that in which the lamp is seen, up to length
};

/// Whether light goes through a pane on the way.
bool isRefracted(const VirtualLight& light);

/// What one pass adds in each view.
struct ScheduledLight {
    std::size_t light = 0;              ///< of the scene
    std::optional<VirtualLight> image;  ///< none: the lamp itself, with all points of its area
    std::size_t points = 1;             ///< of the area
};

/// Faces that take part: their nodes cast shadows. What isn't blocked by a face isn't sent on.
std::vector<bool> sendingFaces(const SceneDescription& scene, const std::vector<SpecularFace>& faces);

/// All of a light's images of 1 to `lightDepth` bounces whose beam, cut by each face's outline, isn't empty. A frosted
/// or glossy face has options.shears of them, each with its share and sheared about the face's normal as a view is (MPR
/// section 3); what other faces send to it, or it to them, is left out. \param sending  one a face
/// \throws nacre::Error when they are more than options.most
std::vector<VirtualLight> virtualLights(const std::vector<SpecularFace>& faces, const std::vector<bool>& sending,
                                        const Light& light, const SpecularOptions& options);

}  // namespace nacre
