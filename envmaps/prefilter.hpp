// Radiance map in, prefiltered maps out: L'(r) = ∫ L(l) k(angle(r, l)) dω / ∫ k dω for each level's lobe (HSE section
// 1.6, eq. 6, normalised, so that a white surrounding gives 1).
#pragma once

#include <span>
#include <vector>

#include "core/environment.hpp"
#include "core/progress.hpp"
#include "envmaps/lobes.hpp"

namespace nacre {

struct PrefilterLevel {
    Lobe lobe;
    int size = 0;  ///< of the result, ≥ 1
};

/// How a level was computed, and what that cost.
struct PrefilterStep {
    int order = 0;            ///< harmonics up to this degree; −1 = none
    double directRadius = 0;  ///< the kernel within this angle was summed texel by texel [rad]; 0 = nowhere
    bool cut = false;  ///< a lobe with a sharp edge (Phong below 0.5): harmonics end before the tolerance is reached
    double seconds = 0;
};

struct PrefilterOptions {
    EnvLayout layout = EnvLayout::Cube;  ///< of the results
    /// Largest error that cutting the harmonics may cause on a map of one point, root mean square as a share of its
    /// mean.
    double tolerance = 6e-4;
    unsigned threads = 0;
    Progress progress{};
};

struct Prefiltered {
    std::vector<EnvMap> levels;
    std::vector<PrefilterStep> steps;
};

/// What is filtered is the source's own texels: radiance times exact solid angle at the texel's centre, whatever the
/// source's layout; each result is divided by the same sum over a white map. Kernels that harmonics of a moderate
/// degree hold are products of coefficients (envmaps/sphere_transform.hpp); of narrower ones the middle is summed
/// directly. Negative values that the cut harmonics bring to a map without any are set to 0. Mirror levels are
/// area-filtered.
/// \param source  finite texels, any layout
/// \throws std::invalid_argument for bad lobes, sizes or texels
Prefiltered prefilter(const EnvMap& source, std::span<const PrefilterLevel> levels, const PrefilterOptions& options);

}  // namespace nacre
