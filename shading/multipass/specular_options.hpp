// How specular faces are drawn. Apart from pass_schedule.hpp, so that switches of a scene can hold it.
#pragma once

#include <cstddef>
#include <vector>

namespace nacre {

/// A refracting face is seen from one virtual eye, made for one incident angle (PR94 "Refractions"): that of …
enum class RefractionAngle {
    WindowCentre,  ///< the ray through the middle of what is seen of the face
    ViewAxis       ///< PR94: the view vector where it meets the face's plane, if it does
};

/// Where that eye is. The ray of the incident angle is right for both.
enum class RefractedEye {
    OnNormal,  ///< on the normal through the eye: right for all rays of that angle, whatever their azimuth
    Turned     ///< PR94: turned about the point where the ray meets the face
};

/// Where the shears of frosted and glossy faces come from.
enum class ShearSampling {
    LowDiscrepancy,  ///< Roberts' R2
    Random           ///< MPR's
};

inline constexpr int kMostLightBounces = 4;
inline constexpr int kMostFilters = 8;  ///< faces with a SceneSpecular::filter on a path from the eye

struct SpecularOptions {
    int depth = 4;       ///< specular surfaces along a path from the eye, ≥ 0
    int lightDepth = 2;  ///< specular surfaces along a path from a lamp with a SceneShadow, 0 to kMostLightBounces;
                         ///< 0: they block such light and send none on
    RefractionAngle angle = RefractionAngle::WindowCentre;
    RefractedEye eye = RefractedEye::OnNormal;
    bool keepDepth = true;  ///< false: PR94's map onto the face, without depths: later draws cover earlier ones
    int shears = 32;        ///< views of the first frosted or glossy face on a path, ≥ 1
    ShearSampling sampling = ShearSampling::LowDiscrepancy;
    int stencilBits = 8;       ///< of the target
    std::size_t most = 20000;  ///< views; more is an error
    bool partial = true;       ///< false: faces don't show the weak part, what refracting ones reflect by Fresnel
    /// Views that aren't drawn: each the faces on its way from the camera, as pathOf says.
    std::vector<std::vector<int>> hidden{};

    bool operator==(const SpecularOptions&) const = default;
};

}  // namespace nacre
