// How wrong horizons, ellipses and scatter maps are, as stored, against rays over the same relief. Samples with their
// truth are values: who compares many bakes of one relief draws them once.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bump/horizon_map.hpp"
#include "bump/scatter_map.hpp"
#include "reference/relief_rays.hpp"

namespace nacre {

// Each draw: texels are uniform among those that are no holes. `count` ≥ 1. Same samples for any thread count.
// \throws std::invalid_argument for a bad map, a map of holes alone, or a bad number

/// Sample i is towards the azimuth 2πk/K, k = i mod K, so that each azimuth has its share.
struct HorizonSamples {
    struct Sample {
        int x, y, k;
        double elevation;  ///< [rad], 0…π/2, exact
    };
    int azimuths = 0;  ///< K
    std::vector<Sample> samples;
};
HorizonSamples drawHorizonSamples(const HeightMap& map, int azimuths, int count = 20000, std::uint64_t seed = 1,
                                  unsigned threads = 0);

struct HorizonError {
    double rmseDeg = 0;              ///< root mean square of the elevations' errors [degrees]
    double rmseDegAlongAxes = 0;     ///< of the azimuths along columns and rows alone
    double rmseDegWorst = 0;         ///< of the azimuth where it is largest
    double maxRad = 0;               ///< largest error
    double shareWithinMilliRad = 0;  ///< share of errors ≤ 1e-3 rad
    int samples = 0;
};
/// \param elevation  [rad] at texel (x, y) towards azimuth k, as decoded from what is stored
HorizonError measureHorizons(const HorizonSamples& samples,
                             const std::function<double(int x, int y, int k)>& elevation);
HorizonError measureHorizons(const HorizonSamples& samples, const HorizonMap& stored);

/// Lights weighted by the cosine about z, one at each texel drawn.
struct LitSamples {
    struct Sample {
        int x, y;
        Vec3 light;
        bool lit;  ///< isLit at the texel's centre
    };
    std::vector<Sample> samples;
};
LitSamples drawLitSamples(const HeightMap& map, int count = 20000, std::uint64_t seed = 1, unsigned threads = 0);

struct LitError {
    double misjudged = 0;  ///< share of the samples that are called lit and aren't, or the other way round
    double dark = 0;       ///< share of the samples that are dark: the error of calling all lit
    int samples = 0;
};
/// \param lit  at texel (x, y) for a light, as decoded from what is stored
LitError measureLit(const LitSamples& samples, const std::function<bool(int x, int y, const Vec3& light)>& lit);

/// One ray of a texel drawn, towards directions[i mod M].
struct SeenSamples {
    struct Sample {
        int x, y, k;
        double distance;  ///< along the plane [texels] to firstHit, −1 for a miss
    };
    std::vector<Vec3> directions;
    std::vector<Sample> samples;
};
SeenSamples drawSeenSamples(const HeightMap& map, const std::vector<Vec3>& directions, int count = 20000,
                            std::uint64_t seed = 1, unsigned threads = 0);

struct SeenError {
    double hitMismatch = 0;     ///< share of the rays that are called a hit and are none, or the other way round
    double beyondOneTexel = 0;  ///< share of the rays that hit in both, whose points are more than a texel apart
    double hits = 0;            ///< share of the rays that hit
    int samples = 0;
};
/// \param distance  along the plane [texels] at texel (x, y) in direction k, < 0 for a miss, as decoded from what is
/// stored. Both points lie on one line, so that they are as far apart as their distances.
SeenError measureSeen(const SeenSamples& samples, const std::function<double(int x, int y, int k)>& distance);
/// \throws std::invalid_argument unless the map has the samples' directions
SeenError measureSeen(const SeenSamples& samples, const ScatterMap& stored);

}  // namespace nacre
