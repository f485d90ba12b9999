// The surface in a volume as rays meet it: followed through the trilinear field in small steps, in double precision.
#pragma once

#include <optional>
#include <vector>

#include "core/volume.hpp"
#include "reference/surface_point.hpp"

namespace nacre {

/// A volume in the world and the value of its surface.
struct TracedVolume {
    const Volume& volume;
    double iso;
    glm::dmat4 toWorld{1};  ///< of the volume's own space
};

class VolumeField {
public:
    /// The volume outlives this. \throws std::invalid_argument: checkVolume's
    explicit VolumeField(const TracedVolume& surface);

    /// The first t in [near, far] inside the surface and the box, by steps of an eighth of a texel and forty
    /// bisections.
    std::optional<double> firstInside(const Ray& ray) const;
    /// The point where `toEye` (unit) came from. Normal: against the interpolated gradient (volumeGradients); towards
    /// the eye where that is zero. Tangents: any.
    SurfacePoint at(const Vec3& position, const Vec3& toEye) const;
    /// Where a ray in this direction (unit) may start that leaves the surface: a thousandth of a texel off.
    double skip(const Vec3& direction) const;

private:
    struct TexelRay;
    bool above(const TexelRay& r, double t) const;
    double bisected(const TexelRay& r, double outside, double inside) const;
    std::optional<TexelRay> clipped(const Ray& ray) const;

    const Volume& volume_;
    double iso_;
    glm::dmat4 toWorld_, fromWorld_;
    glm::dmat3 normals_;
    std::vector<glm::vec3> gradients_;
};

}  // namespace nacre
