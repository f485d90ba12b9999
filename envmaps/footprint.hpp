// A texel's footprint on the sphere, as cells with great-circle edges. Part of convert.cpp.
#pragma once

#include <vector>

#include "core/environment.hpp"

namespace nacre::footprint {

using SpherePolygon = std::vector<Vec3>;  ///< corners; edges are great circles, shorter than π

/// The part of `polygon` with dot(normal, p) ≥ 0. `out` is overwritten.
void clipSphere(const SpherePolygon& polygon, const Vec3& normal, SpherePolygon& out);

/// Texels of one layout and size, cut into cells so that none is wider than 0.2 rad; edges that are no great circles
/// are cut into arcs so that areas are right to 1e-5.
class Footprints {
public:
    Footprints(EnvLayout layout, int size);

    /// Appends the pieces of texel (x, y) to `out`. Together they are the texel; an octahedral border texel's are the
    /// part within the square, and a DualParaboloid's directions go on over the rim.
    void append(int x, int y, std::vector<SpherePolygon>& out) const;

private:
    void appendCell(glm::dvec2 low, glm::dvec2 high, int block, std::vector<SpherePolygon>& out) const;
    void appendOctants(const std::vector<glm::dvec2>& cell, std::vector<SpherePolygon>& out) const;
    Vec3 direction(const glm::dvec2& position, int block) const;

    EnvLayout layout_;
    int size_, stretched_;  ///< stretched_: the size whose directions are used; 2 where a seamed map of size 1 has none
    double offset_;         ///< of its texel positions
    int cells_, segments_;
    bool bent_;  ///< edges get a corner in the middle of each segment
};

}  // namespace nacre::footprint
