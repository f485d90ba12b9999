#include "reference/brdf_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/directions.hpp"

using namespace nacre;

namespace {

constexpr double kRounding = 1e-12;
constexpr double kSampling = 0.01;        // relative error of E_L2 from 200 000 pairs; measured 0.3 % at worst
constexpr double kSearchSampling = 0.03;  // the same from kSearchSamples; measured 1 %
constexpr double kDegree = kPi / 180;

BrdfFunction constant(const Rgb& f) {
    return [f](const Vec3&, const Vec3&) { return f; };
}

/// Gaussian of the half angle: as narrow as one likes, with dependence on θd and φd.
Rgb lobe(const Vec3& wi, const Vec3& wo, double alpha) {
    const HalfDifference a = halfDifference(wi, wo);
    return Rgb(1, 0.5, 0.25) * std::exp(-sqr(a.thetaH / alpha)) * (1 + std::cos(a.thetaD)) / sqr(alpha);
}
/// The lobe with an error that changes sign within it.
Rgb wrongLobe(const Vec3& wi, const Vec3& wo, double alpha) {
    const HalfDifference a = halfDifference(wi, wo);
    return lobe(wi, wo, alpha) * (1 + 0.1 * std::cos(2 * a.thetaH / alpha) + 0.05 * sqr(std::sin(a.thetaD)));
}

/// E_L2 of wrongLobe over θ ≤ 80° by the midpoint rule in (ln θh, θd, φd).
double bruteForceL2(double alpha) {
    constexpr int kH = 120, kD = 120, kPhi = 24;
    const double low = std::log(1e-3 * alpha), high = std::log(std::min(kPi / 2, 6 * alpha)),
                 limit = std::cos(80 * kDegree);
    double error = 0, truth = 0;
    for (int i = 0; i < kH; ++i)
        for (int j = 0; j < kD; ++j)
            for (int k = 0; k < kPhi; ++k) {
                HalfDifference a;
                a.thetaH = std::exp(low + (high - low) * (i + 0.5) / kH);
                a.thetaD = kPi / 2 * (j + 0.5) / kD;
                a.phiD = 2 * kPi * (k + 0.5) / kPhi;
                const auto [wi, wo] = fromHalfDifference(a);
                if (std::min(wi.z, wo.z) < limit) continue;
                const double w = wi.z * wo.z * std::cos(a.thetaD) * std::sin(a.thetaD) * std::sin(a.thetaH) * a.thetaH;
                const Rgb f = lobe(wi, wo, alpha), d = wrongLobe(wi, wo, alpha) - f;
                error += w * glm::dot(d, d);
                truth += w * glm::dot(f, f);
            }
    return std::sqrt(error / truth);
}

double largerAngle(const Vec3& wi, const Vec3& wo) { return std::acos(std::min(wi.z, wo.z)); }

}  // namespace

TEST(BrdfMetrics, AConstantFactorIsTheRelativeError) {
    const BrdfFunction truth = [](const Vec3& wi, const Vec3& wo) { return lobe(wi, wo, 0.2) + Rgb(10); };
    for (double e : {0.05, -0.05}) {
        const BrdfError error = measureBrdf([&](auto& wi, auto& wo) { return truth(wi, wo) * (1 + e); }, truth);
        EXPECT_NEAR(error.l2Rel, 0.05, kRounding);
        EXPECT_NEAR(error.grazingL2Rel, 0.05, kRounding);
        EXPECT_NEAR(error.logRms, std::abs(std::log1p(e)), 1e-5);  // ε beside f ≥ 10
        EXPECT_NEAR(error.maxRel, 0.05, 1e-4);                     // floor beside a peak of 60
        EXPECT_EQ(error.negative + error.nonFinite, 0u);
    }
}

TEST(BrdfMetrics, IdenticalBrdfsHaveNoError) {
    for (double f : {0.0, 0.5 / kPi}) {
        const BrdfError error = measureBrdf(constant(Rgb(f)), constant(Rgb(f)));
        EXPECT_EQ(error.l2Rel, 0);
        EXPECT_EQ(error.logRms, 0);
        EXPECT_EQ(error.maxRel, 0);
        EXPECT_EQ(error.grazingL2Rel, 0);
        EXPECT_EQ(error.albedoMaxAbs, 0);
        EXPECT_EQ(error.spherePsnr, 200);
        EXPECT_GT(error.samples, 50000u);
    }
}

TEST(BrdfMetrics, LambertAgainstLambertHasClosedForms) {
    const Rgb a(0.3, 0.5, 0.9), b(0.4, 0.5, 0.6);  // pooled over channels
    const BrdfError error = measureBrdf(constant(b / kPi), constant(a / kPi));
    EXPECT_NEAR(error.l2Rel, std::sqrt(glm::dot(b - a, b - a) / glm::dot(a, a)), kRounding);
    double square = 0;
    for (int c = 0; c < 3; ++c) square += sqr(std::log((b[c] / kPi + 1e-3) / (a[c] / kPi + 1e-3)));
    EXPECT_NEAR(error.logRms, std::sqrt(square / 3), kRounding);
    EXPECT_NEAR(error.maxRel, 0.3 / kPi / (0.9 / kPi + 1e-2), kRounding);
    EXPECT_NEAR(error.albedoMaxAbs, 0.3, 1e-3);  // quadrature of the cosine with 4096 points
}

TEST(BrdfMetrics, ABlackTruthMakesAnyLightAnInfiniteError) {
    const BrdfError error = measureBrdf(constant(Rgb(1e-3)), constant(Rgb(0)));
    EXPECT_TRUE(std::isinf(error.l2Rel));
    EXPECT_NEAR(error.logRms, std::log(2), kRounding);
}

TEST(BrdfMetrics, SharpLobesConvergeToBruteForce) {
    for (double alpha : {0.5, 0.1, 0.01, 1e-3}) {
        const double expected = bruteForceL2(alpha);
        const BrdfFunction truth = [&](auto& wi, auto& wo) { return lobe(wi, wo, alpha); };
        const BrdfFunction wrong = [&](auto& wi, auto& wo) { return wrongLobe(wi, wo, alpha); };
        BrdfMetricOptions options;
        for (std::uint64_t seed : {0, 1, 2}) {
            options.seed = seed;
            options.samples = 200000;
            EXPECT_NEAR(l2Rel(wrong, truth, options) / expected, 1, kSampling) << "alpha=" << alpha << " seed=" << seed;
            options.samples = kSearchSamples;
            EXPECT_NEAR(l2Rel(wrong, truth, options) / expected, 1, kSearchSampling) << "alpha=" << alpha;
        }
    }
}

TEST(BrdfMetrics, MeasureOfBothHemispheresIsPiSquared) {  // ∫ cosθi cosθo dωi dωo = π²; up to 80° (π sin²80°)²
    double body = 0, all = 0;
    for (const TruthSample& s : sampleTruth(constant(Rgb(1)), {})) {
        all += s.weight;
        if (s.region == TruthSample::Region::Body) body += s.weight;
    }
    EXPECT_NEAR(body / all, std::pow(std::sin(80 * kDegree), 4), 1e-3);
}

TEST(BrdfMetrics, ErrorsInTheGrazingRingShowInGrazingOnly) {
    const auto ring = [](double low, double high) {
        return [=](const Vec3& wi, const Vec3& wo) {
            const double angle = largerAngle(wi, wo);
            return Rgb(angle > low * kDegree && angle < high * kDegree ? 2.0 : 1.0);
        };
    };
    const BrdfError grazing = measureBrdf(ring(80.001, 88.999), constant(Rgb(1)));
    EXPECT_EQ(grazing.l2Rel, 0);
    EXPECT_EQ(grazing.logRms, 0);
    EXPECT_EQ(grazing.maxRel, 0);
    EXPECT_NEAR(grazing.grazingL2Rel, 1, 1e-2);  // the ring but for 0.001° at its edges
    const BrdfError body = measureBrdf(ring(0, 79.999), constant(Rgb(1)));
    EXPECT_NEAR(body.l2Rel, 1, 1e-2);
    EXPECT_EQ(body.grazingL2Rel, 0);
    const BrdfError horizon = measureBrdf(ring(89.001, 90), constant(Rgb(1)));
    EXPECT_EQ(horizon.l2Rel + horizon.grazingL2Rel, 0);
}

TEST(BrdfMetrics, NonFiniteValuesAreCountedAndMakeErrorsInfinite) {
    for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const auto from = [bad](double low) {
            return [=](const Vec3& wi, const Vec3& wo) {
                return Rgb(0.5, largerAngle(wi, wo) > low * kDegree ? bad : 0.5, 0.5);
            };
        };
        const BrdfError body = measureBrdf(from(60), constant(Rgb(0.5)));
        EXPECT_GT(body.nonFinite, 1000u);
        for (double e : {body.l2Rel, body.logRms, body.maxRel, body.grazingL2Rel, body.albedoMaxAbs, -body.spherePsnr})
            EXPECT_EQ(e, std::numeric_limits<double>::infinity());
        const BrdfError horizon = measureBrdf(from(89.5), constant(Rgb(0.5)));
        EXPECT_GT(horizon.nonFinite, 10u);
        EXPECT_EQ(horizon.l2Rel, 0);
        EXPECT_TRUE(std::isinf(horizon.grazingL2Rel));
    }
}

TEST(BrdfMetrics, NegativeValuesAreCountedAndStayInTheL2) {
    const BrdfFunction negative = [](const Vec3& wi, const Vec3&) { return Rgb(wi.x > 0 ? 1.0 : -1.0, 1, 1); };
    const BrdfError error = measureBrdf(negative, constant(Rgb(1)));
    EXPECT_NEAR(static_cast<double>(error.negative) / static_cast<double>(error.samples), 0.75, 0.25);  // half, to 90°
    EXPECT_NEAR(error.l2Rel, std::sqrt(4. / 6), 1e-2);
    EXPECT_TRUE(std::isfinite(error.logRms));
}

TEST(BrdfMetrics, ABrokenTruthIsRefused) {
    EXPECT_THROW(measureBrdf(constant(Rgb(1)), constant(Rgb(std::nan("")))), std::invalid_argument);
    EXPECT_THROW(measureBrdf(constant(Rgb(1)), constant(Rgb(1, -1, 1))), std::invalid_argument);
    EXPECT_THROW(measureBrdf(constant(Rgb(1)), constant(Rgb(1)), {.samples = 1}), std::invalid_argument);
}

TEST(BrdfMetrics, SameBitsForAnyThreadCount) {
    const BrdfFunction truth = [](auto& wi, auto& wo) { return lobe(wi, wo, 0.1); };
    const BrdfFunction wrong = [](auto& wi, auto& wo) { return wrongLobe(wi, wo, 0.1); };
    const BrdfError one = measureBrdf(wrong, truth, {.samples = 20000, .threads = 1});
    const BrdfError seven = measureBrdf(wrong, truth, {.samples = 20000, .threads = 7});
    EXPECT_EQ(one.l2Rel, seven.l2Rel);
    EXPECT_EQ(one.logRms, seven.logRms);
    EXPECT_EQ(one.maxRel, seven.maxRel);
    EXPECT_EQ(one.grazingL2Rel, seven.grazingL2Rel);
    EXPECT_EQ(one.spherePsnr, seven.spherePsnr);
    EXPECT_EQ(one.albedoMaxAbs, seven.albedoMaxAbs);
    EXPECT_EQ(one.samples, seven.samples);
}

TEST(BrdfMetrics, EnergySeenIsOneUnlessPeaksAreMissed) {
    const double lambert = 3 * sqr(0.5) * sqr(kPi * sqr(std::sin(80 * kDegree)));  // ∫ f² dμ of f = 0.5
    BrdfMetricOptions options{.truthEnergy = lambert};
    EXPECT_NEAR(measureBrdf(constant(Rgb(0.5)), constant(Rgb(0.5)), options).energySeen, 1, kSampling);
    options.truthEnergy = 4 * lambert;  // three quarters are somewhere that no pair sees
    EXPECT_NEAR(measureBrdf(constant(Rgb(0.5)), constant(Rgb(0.5)), options).energySeen, 0.25, kSampling);
    EXPECT_TRUE(std::isnan(measureBrdf(constant(Rgb(0.5)), constant(Rgb(0.5))).energySeen));
}

TEST(BrdfMetrics, JsonNamesEveryField) {
    BrdfError error;
    error.l2Rel = 0.25;
    error.spherePsnr = -std::numeric_limits<double>::infinity();
    error.negative = 7;
    const nlohmann::json json = toJson(error);
    for (const char* key : {"l2_rel", "log_rms", "max_rel", "grazing_l2_rel", "sphere_psnr", "albedo_max_abs",
                            "energy_seen", "samples", "negative", "non_finite"})
        EXPECT_TRUE(json.contains(key)) << key;
    EXPECT_EQ(json["l2_rel"], 0.25);
    EXPECT_EQ(json["negative"], 7);
    EXPECT_TRUE(nlohmann::json::parse(json.dump())["sphere_psnr"].is_null());
}

TEST(BrdfMetrics, BlackTruthAcceptsBlackAlone) {
    const auto grey = [](double f) { return [f](const Vec3&, const Vec3&) { return Rgb(f); }; };
    BrdfMetricOptions options;
    options.samples = 2000;
    EXPECT_EQ(l2Rel(grey(0), grey(0), options), 0);
    EXPECT_EQ(l2Rel(grey(1e-13), grey(0), options), 0) << "what exp(-30) of a table leaves";
    EXPECT_EQ(l2Rel(grey(1e-3), grey(0), options), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(l2Rel(grey(1.1e-7), grey(1e-7), options), 0.1, 1e-9) << "dark, but not black";
    EXPECT_EQ(measureBrdf(grey(1e-13), grey(0), options).grazingL2Rel, 0);
}
