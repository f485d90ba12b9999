// Sums of a surrounding over a lobe for every direction, by brute force: what the ray tracer looks up where a sum for
// each of its rays would take hours.
#pragma once

#include "core/environment.hpp"
#include "core/progress.hpp"
#include "envmaps/lobes.hpp"

namespace nacre {

/// A map of the mean radiance of `size` rows: each texel the mean of those it covers. Latitude-longitude.
EnvMap areaAveraged(const EnvMap& source, int size, unsigned threads = 0);

struct LobeTableOptions {
    /// Texels of the table, and of the averaged source that is summed, across the lobe's width. The table's bilinear
    /// filter is off by about 1/(8 n²) of the lobe's height, the sum by 1/(24 n²).
    int perWidth = 8;
    int most = 192;  ///< largest edge of the table, and half the largest height of the averaged source [texels]
    unsigned threads = 0;
    Progress progress{};
};

/// L'(r) = Σ L w(r, l) dω / Σ w dω at the centres of a cube's texels, w by lobeWeight
/// (reference/environment_error.hpp); texels of the source further than the lobe's support are left out. Lobes too
/// narrow for `most` come out wider: lobeTableResolution tells. \throws std::invalid_argument for a mirror, which is
/// looked up in the source itself
EnvMap tabulateLobe(const EnvMap& source, const Lobe& lobe, const LobeTableOptions& options = {});

/// Texels across the lobe's width that tabulateLobe has, at most perWidth: below 3 the table is no truth.
double lobeTableResolution(const Lobe& lobe, const LobeTableOptions& options = {});

}  // namespace nacre
