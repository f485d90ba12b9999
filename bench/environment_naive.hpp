// Ways to prefilter that others use, written plainly for comparison.
#pragma once

#include <vector>

#include "core/environment.hpp"
#include "envmaps/lobes.hpp"

namespace nacre::bench {

/// A cube and its mip levels, each texel the plain mean of four (as drivers make them), down to one texel a face.
class CubePyramid {
public:
    explicit CubePyramid(EnvMap cube);
    /// Trilinear, seamless.
    Rgb sample(const Vec3& direction, double lod) const;
    int size() const { return levels_.front().size(); }

private:
    std::vector<EnvMap> levels_;
};

/// Importance sampling with `count` Hammersley points: l drawn from the lobe's density (Ggx: h from D(h) cosθh,
/// weighted by n·l; Diffuse and Phong: l itself), Σ w L / Σ w. \param filtered  each sample reads the mip level whose
/// texels are as large as its share of the lobe, Ω = 1/(count · pdf) (Křivánek & Colbert 2008); else the source's own
/// texels. \throws std::invalid_argument for lobes other than Diffuse, Phong and Ggx
Rgb importanceSampled(const CubePyramid& source, const Lobe& lobe, const Vec3& r, int count, bool filtered);

}  // namespace nacre::bench
