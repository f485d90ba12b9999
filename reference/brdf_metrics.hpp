// How far an approximate BRDF is from the true one. Every error that nacre prints or stores is defined here, once.
// In all integrals dμ = cosθi cosθo dωi dωo, and the three colour channels are pooled: squares are summed over channels
// above and below the fraction line.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "factorize/reflectance.hpp"

namespace nacre {

struct BrdfMetricOptions {
    std::uint64_t samples = 200000;  ///< pairs drawn, 2 to 2^32; those below the horizon are drawn too
    bool isotropic = true;           ///< of the truth; decides whether the albedo is asked at one azimuth or at four
    unsigned threads = 0;            ///< 0 = all cores, same bits for any
    double truthEnergy = std::numeric_limits<double>::quiet_NaN();  ///< Reflectance::energy
    std::uint64_t seed = 0;  ///< shifts the points; two seeds show how far the estimates have converged
};

/// Samples that suffice for a search over many candidates: l2_rel within a few per cent of its converged value.
inline constexpr std::uint64_t kSearchSamples = 40000;

struct BrdfError {
    /// E_L2 = √(∫(f̂−f)² dμ / ∫f² dμ) over θi, θo ≤ 80°. For a black truth 0 when f̂ too is black, to 1e-6 1/sr in the
    /// root mean square, and infinite when it isn't.
    double l2Rel = 0;
    /// E_log = √(∫ln²((max(f̂,0)+ε)/(f+ε)) dμ / (3 ∫dμ)) over θi, θo ≤ 80°, ε = 1e-3 1/sr.
    double logRms = 0;
    /// max |f̂−f| / (f + 0.01 1/sr) over samples with θi, θo ≤ 80° and channels. The floor is the f of a 3 % grey
    /// diffuser: differences far below it don't count.
    double maxRel = 0;
    /// E_L2 over pairs whose larger angle lies in 80° to 89°.
    double grazingL2Rel = 0;
    /// spherePsnr(approximate, truth) [dB], see reference/sphere_psnr.hpp.
    double spherePsnr = 0;
    /// max |∫(f̂−f) cosθi dωi| over 16 θo between 2.8° and 87.2° (and 4 φo unless isotropic) and channels.
    double albedoMaxAbs = 0;
    /// Share of options.truthEnergy that the pairs of the L2 see: 1 within a few per cent. Far from 1, the truth has
    /// peaks between the pairs, and the errors here say little. NaN without truthEnergy.
    double energySeen = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t samples = 0;    ///< pairs with θi, θo ≤ 80° that entered
    std::uint64_t negative = 0;   ///< pairs (of all, up to 90°) with a channel of f̂ < 0
    std::uint64_t nonFinite = 0;  ///< pairs (of all, up to 90°) with a channel of f̂ that is no finite number
};

/// energySeen further from 1 than this is worth a warning: what is not seen then matters to the L2.
inline constexpr double kEnergyTolerance = 0.2;

/// All of the above. A non-finite f̂ makes the errors of its region infinite (the PSNR −∞), never skipped; one beyond
/// 89° counts as grazing. Cost: about samples/2 + 40 000 evaluations of both, 230 000 more when anisotropic. \throws
/// std::invalid_argument when samples is out of range, or the truth is negative or not finite somewhere
BrdfError measureBrdf(const BrdfFunction& approximate, const BrdfFunction& truth,
                      const BrdfMetricOptions& options = {});

/// The fields by the names of README.md: l2_rel, log_rms, … Numbers that are not finite stay so (written: null).
nlohmann::json toJson(const BrdfError& error);

/// The truth at the points of comparison, evaluated once for many candidates.
struct TruthSample {
    enum class Region : std::uint8_t { Body, Grazing, Horizon };  ///< larger angle ≤ 80°, ≤ 89°, < 90°
    Vec3 wi, wo;
    Rgb f;
    double weight = 0;  ///< of dμ [sr²], up to a common factor
    Region region = Region::Body;
};
/// \throws std::invalid_argument as measureBrdf
std::vector<TruthSample> sampleTruth(const BrdfFunction& truth, const BrdfMetricOptions& options = {});

/// E_L2 alone, for searches.
double l2Rel(const BrdfFunction& approximate, const std::vector<TruthSample>& truth, unsigned threads = 0);
double l2Rel(const BrdfFunction& approximate, const BrdfFunction& truth, const BrdfMetricOptions& options = {});

}  // namespace nacre
