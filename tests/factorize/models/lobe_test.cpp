// Phong, Blinn-Phong, cosine lobe, Lambert, Banks.
#include <gtest/gtest.h>

#include "model_test_util.hpp"

using namespace nacre;
using namespace nacre::test;

constexpr double kQuadrature = 1e-4;  // 256² midpoints; measured below 2e-5 on smooth integrands

TEST(Lobes, NormalisedAtNormalIncidence) {
    for (const std::string model : {"phong", "blinn-phong", "cosine-lobe"})
        for (const std::string n : {"0", "1", "10", "1000", "1000000"}) {
            const Reflectance r = makeModel(model + ":ks=0.7,kd=0.2,n=" + n);
            const double w = std::min(1.0, std::sqrt(2 / (std::stod(n) + 2)));
            const double a = albedo(makeModel(model + ":ks=0.7,n=" + n), Vec3(0, 0, 1), w).r;
            EXPECT_NEAR(a, 0.7, 10 * kQuadrature)
                << model << " " << n;  // the lobe ends at the horizon in mid-cell for n = 0
            EXPECT_NEAR(r.singleLobe->diffuse.r, 0.2 / kPi, 1e-15);
        }
}

TEST(Lobes, NeverReflectMoreThanAtNormalIncidence) {
    for (const std::string text :
         {"phong:n=5", "phong:n=200", "blinn-phong:n=1", "blinn-phong:n=5", "blinn-phong:n=200",
          "cosine-lobe:cxy=-1,cz=0.9,n=20", "cosine-lobe:cx=1,cy=-1,cz=1,n=3"}) {
        const Reflectance model = makeModel(text);
        const double w = std::sqrt(2 / (model.singleLobe->exponent + 2));
        for (double deg : {0., 20., 45., 70., 89.})
            EXPECT_LE(albedo(model, sphericalDirection(deg * kDegree, 0.4), w).r, 1 + 20 * kQuadrature)
                << text << " " << deg;
    }
}

TEST(Lobes, PeakValues) {
    const Vec3 wi = sphericalDirection(0.7, 1.0), mirror(-wi.x, -wi.y, wi.z);
    EXPECT_NEAR(makeModel("phong:n=40").f(wi, mirror).r, 42 / (2 * kPi), 1e-9);
    EXPECT_EQ(makeModel("cosine-lobe:n=40").f(wi, mirror), makeModel("phong:n=40").f(wi, mirror));
    EXPECT_NEAR(makeModel("blinn-phong:n=40").f(wi, mirror).r, 42. * 44. / (8 * kPi * (40 + std::exp2(-20.))), 1e-9);
    EXPECT_NEAR(makeModel("blinn-phong:n=0").f(wi, mirror).r, 1 / kPi, 1e-12);  // n = 0 is Lambert
    EXPECT_NEAR(makeModel("phong:n=1000000").f(wi, mirror).r, 1000002 / (2 * kPi), 1e-3);
    EXPECT_EQ(makeModel("lambert:kd=0.3").f(wi, mirror).r, 0.3 / kPi);
}

TEST(Lobes, LobeIsZeroBehindAndAmbientStaysOutOfF) {
    const Reflectance model = makeModel("phong:n=0,ambient=0.25,kd=0.5");
    EXPECT_EQ(model.singleLobe->lobe(0), Rgb(0));
    EXPECT_EQ(model.singleLobe->lobe(-0.5), Rgb(0));
    EXPECT_EQ(model.singleLobe->ambient, Rgb(0.25));
    EXPECT_NEAR(model.f(Vec3(0, 0, 1), Vec3(0, 0, 1)).r, 0.5 / kPi + 1 / kPi, 1e-12);
}

TEST(Lobes, GeneralAxisIsAnisotropic) {
    const Reflectance model = makeModel("cosine-lobe:cx=-1,cy=0.2,cz=0.8,n=3,kd=0.1");
    const Vec3 wi = sphericalDirection(0.7, 1.0), wo = sphericalDirection(0.4, 4.0);
    const double s = -wi.x * wo.x + 0.2 * wi.y * wo.y + 0.8 * wi.z * wo.z;
    EXPECT_NEAR(model.f(wi, wo).r, 0.1 / kPi + 5 / (2 * kPi) * s * s * s, 1e-12);
    EXPECT_FALSE(model.isotropic);
}

TEST(Banks,
     BrightestNormalOfTheFibre) {  // search over the normals perpendicular to t with v turned into the plane of t and l
    std::mt19937 random(10);
    const Reflectance model = makeModel("banks:kd=0.3,ks=0.6,n=25");
    for (int i = 0; i < 100; ++i) {
        const Vec3 wi = randomDirection(random), wo = randomDirection(random);
        const Vec3 l(wi.x, 0, std::hypot(wi.y, wi.z)),
            v(wo.x, 0, std::hypot(wo.y, wo.z));     // both turned about t to y = 0
        const double nh = glm::normalize(l + v).z;  // n' = z there
        EXPECT_NEAR(model.f(wi, wo).r, 0.3 * l.z + 0.6 * std::pow(nh, 25), 1e-12);
    }
}

TEST(Banks, HighlightWhereTheFibreMirrors) {  // t·v = −t·l: the cone of reflection, f = kd sl + ks
    const Reflectance model = makeModel("banks:kd=0.1,ks=0.5,r=0.000001");
    const Vec3 wi = glm::normalize(Vec3(0.6, 0.1, 0.7)),
               wo = glm::normalize(Vec3(-wi.x, std::sqrt(1 - wi.x * wi.x) * 0.6, std::sqrt(1 - wi.x * wi.x) * 0.8));
    EXPECT_NEAR(model.f(wi, wo).r, 0.1 * std::sqrt(1 - wi.x * wi.x) + 0.5, 1e-8);
    EXPECT_NEAR(model.tangent->exponent, 1e6, 1e-3);
    EXPECT_EQ(makeModel("banks:r=0.5").source, makeModel("banks:n=2").source);
}

TEST(Banks, SpecularTermIsReciprocal) {
    std::mt19937 random(11);
    const Reflectance model = makeModel("banks:kd=0");
    for (int i = 0; i < 100; ++i) {
        const Vec3 wi = randomDirection(random), wo = randomDirection(random);
        EXPECT_NEAR(model.f(wi, wo).r, model.f(wo, wi).r, 1e-15);
    }
}
