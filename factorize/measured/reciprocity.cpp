#include "factorize/measured/reciprocity.hpp"

#include "core/directions.hpp"
#include "core/error.hpp"
#include "core/sampling.hpp"

namespace nacre {

static const double kMinCosine = std::cos(80 * kPi / 180);

/// dωi dωo = 4 cosθd dωh dωd, and θh = (π/2)u² makes dωh = π u sinθh du dφh. Constant factors cancel.
double reciprocityResidual(const BrdfFunction& raw, int samples) {
    require(samples >= 1, "reciprocityResidual: samples must be >= 1");
    double difference = 0, total = 0;
    for (int i = 1; i <= samples; ++i) {
        const auto n = static_cast<std::uint64_t>(i);
        const Vec3 u = halton3(n);
        const HalfDifference angles{kPi / 2 * u.x * u.x, 2 * kPi * radicalInverse(n, 7), kPi / 2 * u.y, 2 * kPi * u.z};
        const DirectionPair pair = fromHalfDifference(angles);
        if (std::min(pair.wi.z, pair.wo.z) < kMinCosine) continue;
        const double weight =
            pair.wi.z * pair.wo.z * std::cos(angles.thetaD) * std::sin(angles.thetaD) * std::sin(angles.thetaH) * u.x;
        const Rgb there = raw(pair.wi, pair.wo), back = raw(pair.wo, pair.wi);
        difference += weight * dot(there - back, there - back);
        total += weight * 0.5 * (dot(there, there) + dot(back, back));
    }
    return total > 0 ? std::sqrt(difference / total) : 0.0;
}

}  // namespace nacre
