// Directions drawn where a surrounding is bright.
#pragma once

#include <vector>

#include "core/environment.hpp"

namespace nacre {

/// A latitude-longitude map whose radiance is constant over each texel. A texel is drawn with the probability of its
/// power (largest channel times solid angle), a direction within it evenly.
class BrightTexels {
public:
    /// \throws std::invalid_argument for another layout
    explicit BrightTexels(EnvMap map);

    Vec3 draw(const Vec2& square) const;  ///< \param square  a point of [0,1]²; a black map: even on the sphere
    double density(const Vec3& direction) const;  ///< of draw [1/sr]
    Rgb radiance(const Vec3& direction) const;

private:
    std::size_t texelOf(const Vec3& direction) const;
    EnvMap map_;
    std::vector<double> upTo_, density_;
};

}  // namespace nacre
