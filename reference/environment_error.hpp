// Truth for prefiltered environments: each lobe once more by its paper's vectors, summed over every texel of the source
// in double precision; and the error of a map against it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/environment.hpp"
#include "core/progress.hpp"
#include "envmaps/lobes.hpp"

namespace nacre {

/// The lobe's weight for light from l when the map is looked up with r, by half vectors: Ggx and Beckmann with
/// h ∝ l + r; refraction with h ∝ −(r' + ior·l), r' = −r the viewer and n = r' (Walter 2007, eq. 16, 17); not
/// normalised. \throws std::invalid_argument for Mirror
double lobeWeight(const Lobe& lobe, const Vec3& r, const Vec3& l);

/// Σ L_i w(r, l_i) Ω_i / Σ w(r, l_i) Ω_i over the source's texels: radiance constant over each, l_i its centre, Ω_i its
/// exact solid angle. The nearest texel where no centre has a weight. O(texels).
class EnvironmentTruth {
public:
    explicit EnvironmentTruth(const EnvMap& source, unsigned threads = 0);
    Rgb operator()(const Lobe& lobe, const Vec3& r) const;

private:
    struct Texel {
        Vec3 direction;
        double solidAngle;
        Rgb radiance;
    };
    std::vector<Texel> texels_;
    const EnvMap* source_;
};

/// Relative to the mean of the truth over the samples, colour channels pooled.
struct EnvironmentError {
    double rmse = 0, p95 = 0, max = 0;                          ///< at texel centres
    double filteredRmse = 0, filteredP95 = 0, filteredMax = 0;  ///< at any direction, through the bilinear filter
    double mean = 0;                                            ///< of the truth at texel centres
    int samples = 0;                                            ///< of either kind
};

/// `samples` texels drawn uniformly, and as many directions uniform on the sphere.
EnvironmentError measureEnvironment(const EnvMap& map, const EnvironmentTruth& truth, const Lobe& lobe,
                                    int samples = 300, std::uint64_t seed = 1, unsigned threads = 0);

/// Where maps of one layout and size are measured, with the truth there: the truth costs far more than a bake, so
/// that who compares many bakes of one lobe draws it once.
struct EnvironmentSamples {
    EnvLayout layout = EnvLayout::Cube;
    int size = 0;
    std::vector<glm::ivec2> texels;
    std::vector<Vec3> directions;  ///< the texels' centres, then as many uniform on the sphere
    std::vector<Rgb> expected;     ///< the truth at each direction
};
EnvironmentSamples drawEnvironmentSamples(EnvLayout layout, int size, const EnvironmentTruth& truth, const Lobe& lobe,
                                          int samples = 300, std::uint64_t seed = 1, unsigned threads = 0);
/// \throws std::invalid_argument unless the map has the samples' layout and size
EnvironmentError measureEnvironment(const EnvMap& map, const EnvironmentSamples& samples);

}  // namespace nacre
