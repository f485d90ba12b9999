// The cosine power that stands for Ward's Gaussian (MPR section 5).
#include "factorize/ward_phong.hpp"

#include <gtest/gtest.h>

#include "factorize/models/models.hpp"

namespace nacre {
namespace {

Vec3 at(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(WardPhong, WardIsTheModelTimesTheCosine) {
    const Reflectance model = makeModel("ward:alpha=0.2,ks=1,kd=0");
    for (const Vec3& wi : {at(0.2, 0), at(1.2, 1), at(0.7, 3)})
        for (const Vec3& wo : {at(0.3, 3), at(1.1, 4), at(0.65, 0.1)})
            EXPECT_NEAR(wardSpecular(wi, wo, 0.2), model.f(wi, wo).r * wi.z, 1e-9);
}

TEST(WardPhong, PapersFitIsTheLimitOfPerpendicularLight) {
    const CosinePower p = paperCosinePower(0.05);
    EXPECT_NEAR(p(at(0, 0), at(0, 0)) / wardSpecular(at(0, 0), at(0, 0), 0.05), 1, 1e-3);
    EXPECT_LT(cosinePowerErrorAt(p, 0.05, 0.0), 0.01);
}

TEST(WardPhong, OurFitIsTheBestOfItsNeighbours) {
    for (const double alpha : {0.03, 0.1, 0.3}) {
        const CosinePower best = fitCosinePower(alpha);
        const double error = cosinePowerError(best, alpha);
        EXPECT_LT(error, cosinePowerError(paperCosinePower(alpha), alpha));
        for (const double f : {0.97, 1.03}) {
            EXPECT_LT(error, cosinePowerError({best.scale * f, best.exponent}, alpha)) << alpha;
            EXPECT_LT(error, cosinePowerError({best.scale, best.exponent * f}, alpha)) << alpha;
        }
    }
}

TEST(WardPhong, GrazingLightIsWhatAPowerCannotFollow) {
    const CosinePower p = fitCosinePower(0.1);
    EXPECT_GT(cosinePowerErrorAt(p, 0.1, 1.3), 2 * cosinePowerErrorAt(p, 0.1, 0.5));
}

TEST(WardPhong, RejectsBadAlpha) {
    EXPECT_THROW(fitCosinePower(0), std::invalid_argument);
    EXPECT_THROW(cosinePowerError({}, 0.1, 2), std::invalid_argument);
    EXPECT_THROW(cosinePowerErrorAt({}, 7, 0.1), std::invalid_argument);
}

TEST(WardPhong, MeasuredMaterialsReflectLessThanTheyGet) {
    for (const WardMeasured& m : kWardMeasured) EXPECT_LT(m.diffuse + m.specular, 1) << m.name;
}

}  // namespace
}  // namespace nacre
