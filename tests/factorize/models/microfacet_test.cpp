// Torrance-Sparrow, GGX, Ward, Ashikhmin-Shirley, Schlick: normalisation, energy, and the textbook formulas again.
#include <gtest/gtest.h>

#include "model_test_util.hpp"

using namespace nacre;
using namespace nacre::test;

constexpr double kQuadrature = 1e-4;   // 256² midpoints; measured below 2e-5 on smooth integrands
constexpr double kHorizonEdge = 4e-3;  // integrands that end at the horizon in mid-cell

namespace {

double width(const Reflectance& model) {
    return std::max(1e-3, std::max(model.microfacet->alphaX, model.microfacet->alphaY));
}

double projectedArea(const Reflectance& model, double w) {
    return integrateHalfVectors(w, [&](const Vec3& h) { return Rgb(model.microfacet->distribution(h) * h.z); }).x;
}

}  // namespace

TEST(Microfacet, DistributionsAreNormalised) {
    for (const std::string d : {"beckmann", "ggx", "gaussian"})
        for (const std::string alpha : {"0.0001", "0.001", "0.1", "0.5", "1"}) {
            const Reflectance model = makeModel("torrance-sparrow:d=" + d + ",alpha=" + alpha);
            EXPECT_NEAR(projectedArea(model, std::stod(alpha)), 1, kQuadrature) << d << " " << alpha;
        }
    for (const std::string text :
         {"ggx:alphax=0.1,alphay=0.4", "ggx:alphax=1,alphay=0.2", "ward:variant=gmd,alphax=0.1,alphay=0.3"})
        EXPECT_NEAR(projectedArea(makeModel(text), 0.2), 1, kQuadrature) << text;
    EXPECT_NEAR(projectedArea(makeModel("schlick:r=0.09"), 0.3), 1, kQuadrature);
    // (n + 1)/(n + 2), as published
    EXPECT_NEAR(projectedArea(makeModel("ashikhmin-shirley:n=10"), 0.4), 11.0 / 12.0, kQuadrature);
}

TEST(Microfacet, TextbookFormulaInAngles) {  // Beckmann, Smith, V-cavity through acos and tan, at moderate angles
    std::mt19937 random(5);
    const Reflectance smith = makeModel("torrance-sparrow:alpha=0.3,f=schlick,f0=0.5,kd=0.2");
    const Reflectance groove = makeModel("torrance-sparrow:alpha=0.3,f=none,g=v-cavity");
    const Reflectance cook = makeModel("cook-torrance:alpha=0.3,f=none");
    for (int i = 0; i < 200; ++i) {
        const Vec3 wi = randomDirection(random), wo = randomDirection(random), h = halfVector(wi, wo);
        if (std::min(wi.z, wo.z) < 0.02) continue;
        const double delta = std::acos(h.z), c = glm::dot(wo, h), t = std::tan(delta) / 0.3;
        const double d = std::exp(-t * t) / (kPi * 0.09 * std::pow(h.z, 4));
        const auto g1 = [](double z) {
            const double a = 1 / (0.3 * std::tan(std::acos(z)));
            const double lambda = 0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
            return 1 / (1 + lambda);
        };
        const double f = 0.5 + 0.5 * std::pow(1 - c, 5);
        const double expected = 0.2 / kPi + f * d * g1(wi.z) * g1(wo.z) / (4 * wi.z * wo.z);
        EXPECT_NEAR(smith.f(wi, wo).r / expected, 1, 1e-9);
        const double g = std::min({1.0, 2 * h.z * wo.z / c, 2 * h.z * wi.z / c});
        EXPECT_NEAR(groove.f(wi, wo).r, d * g / (4 * wi.z * wo.z), 1e-9 * d * g / (wi.z * wo.z));
        EXPECT_NEAR(cook.f(wi, wo).r, d * g / (kPi * wi.z * wo.z), 1e-9 * d * g / (wi.z * wo.z));
    }
}

TEST(Microfacet, GgxSmithTermsInHeitzForm) {  // Λ = (√(1 + α²tan²θ) − 1)/2
    std::mt19937 random(6);
    const Reflectance separable = makeModel("ggx:alpha=0.4,f=none,g=smith"),
                      correlated = makeModel("ggx:alpha=0.4,f=none");
    for (int i = 0; i < 200; ++i) {
        const Vec3 wi = randomDirection(random), wo = randomDirection(random), h = halfVector(wi, wo);
        const auto lambda = [](double z) { return 0.5 * (std::sqrt(1 + 0.16 * (1 / (z * z) - 1)) - 1); };
        const double c2 = h.z * h.z, d = 0.16 / (kPi * sqr(1 + (0.16 - 1) * c2)), base = d / (4 * wi.z * wo.z);
        const double li = lambda(wi.z), lo = lambda(wo.z);
        EXPECT_NEAR(separable.f(wi, wo).r * (1 + li) * (1 + lo) / base, 1, 1e-9);
        EXPECT_NEAR(correlated.f(wi, wo).r * (1 + li + lo) / base, 1, 1e-9);
    }
}

TEST(Microfacet, AlbedoStaysBelowOneWhereTheModelPromisesIt) {
    for (const std::string text :
         {"torrance-sparrow:f=none,alpha=0.001", "torrance-sparrow:f=none,alpha=0.3", "torrance-sparrow:f=none,alpha=1",
          "torrance-sparrow:f=none,d=ggx,alpha=0.5", "torrance-sparrow:f=none,d=gaussian,alpha=0.3,g=v-cavity",
          "torrance-sparrow:f=none,d=gaussian,alpha=1,g=v-cavity", "ggx:f=none,alphax=0.1,alphay=0.4",
          "ggx:f=none,alphax=1,alphay=0.01,g=smith", "ward:ks=1,variant=gmd,alphax=0.1,alphay=0.3",
          "ward:ks=1,variant=gmd,alpha=1", "ward:ks=1", "ashikhmin-shirley:rs=1,nu=50,nv=500",
          "ashikhmin-shirley:rs=0.3,rd=0.7,n=100", "ashikhmin-shirley:rs=1,n=1", "schlick:f0=1,r=1"}) {
        const Reflectance model = makeModel(text);
        for (double deg : {0., 30., 60., 80., 89., 89.9})
            for (double phi : {0., 0.8, kPi / 2}) {
                const Rgb a = albedo(model, sphericalDirection(deg * kDegree, phi), width(model));
                EXPECT_LE(maxComponent(a), 1 + kHorizonEdge) << text << " at " << deg << " degrees";
            }
    }
}

TEST(Microfacet, SmoothSurfaceReflectsItsFresnelTerm) {  // alpha → 0: the albedo is F(θ) alone
    const Reflectance model = makeModel("torrance-sparrow:alpha=0.001,f=conductor,eta=0.2/0.4/1.4,k=3.9/2.4/1.6");
    for (double deg : {0., 45., 75.}) {
        const Rgb a = albedo(model, sphericalDirection(deg * kDegree, 0.3), 1e-3);
        const Rgb f = model.microfacet->fresnel(std::cos(deg * kDegree));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], f[c], 1e-3) << deg;
    }
}

TEST(Microfacet, IndexOneLeavesTheDiffuseTermAlone) {
    for (const std::string text :
         {"torrance-sparrow:eta=1,kd=0.5", "torrance-sparrow:f=conductor,eta=1,k=0,kd=0.5", "ggx:eta=1,kd=0.5"}) {
        const Reflectance model = makeModel(text);
        for (double deg : {0., 60., 89.9})
            EXPECT_EQ(model.f(sphericalDirection(deg * kDegree, 0), sphericalDirection(89.9 * kDegree, kPi)),
                      Rgb(0.5 / kPi));
    }
}

TEST(Microfacet, IndexTwoHundredIsNearlyAMirror) {
    const double f = maxComponent(makeModel("torrance-sparrow:eta=200").microfacet->fresnel(1.0));
    EXPECT_NEAR(f, sqr(199.0 / 201.0), 1e-12);
}

TEST(Microfacet, ValueAtNormalIncidence) {
    const Vec3 n(0, 0, 1);
    EXPECT_NEAR(makeModel("torrance-sparrow:alpha=0.1,f=none").f(n, n).r, 1 / (4 * kPi * 0.01), 1e-9);
    EXPECT_NEAR(makeModel("cook-torrance:alpha=0.1,f=none").f(n, n).r, 1 / (kPi * kPi * 0.01), 1e-9);
    EXPECT_NEAR(makeModel("ggx:alphax=0.1,alphay=0.4,f=none").f(n, n).r, 1 / (4 * kPi * 0.04), 1e-9);
    for (const std::string variant : {"ward1992", "duer", "gmd"})
        EXPECT_NEAR(makeModel("ward:alphax=0.1,alphay=0.3,variant=" + variant).f(n, n).r, 0.5 / (4 * kPi * 0.03), 1e-9);
    EXPECT_NEAR(makeModel("ashikhmin-shirley:nu=50,nv=500").f(n, n).r, 0.5 * std::sqrt(51. * 501.) / (8 * kPi), 1e-9);
    EXPECT_NEAR(makeModel("schlick:r=0.04,f0=0.5").f(n, n).r, 0.5 / (4 * kPi * 0.04), 1e-9);
}

TEST(Ward, PublishedFormulas) {  // the three papers' expressions, with unnormalised half vectors and angles
    std::mt19937 random(7);
    const double ax = 0.2, ay = 0.5;
    const std::string text = "ward:ks=1,alphax=0.2,alphay=0.5,variant=";
    const Reflectance ward = makeModel(text + "ward1992"), duer = makeModel(text + "duer"),
                      gmd = makeModel(text + "gmd");
    for (int i = 0; i < 200; ++i) {
        const Vec3 wi = randomDirection(random), wo = randomDirection(random), h = halfVector(wi, wo), s = wi + wo;
        const double tan2 = sqr(std::tan(std::acos(h.z))), phi = std::atan2(h.y, h.x);
        const double e = std::exp(-tan2 * (sqr(std::cos(phi) / ax) + sqr(std::sin(phi) / ay))) / (kPi * ax * ay);
        const auto near = [](double value, double expected) { EXPECT_NEAR(value, expected, 1e-9 * expected); };
        near(ward.f(wi, wo).r, e / (4 * std::sqrt(wi.z * wo.z)));
        near(duer.f(wi, wo).r, e / (4 * wi.z * wo.z));
        near(gmd.f(wi, wo).r, e * glm::dot(s, s) / std::pow(s.z, 4));
    }
}

TEST(AshikhminShirley, PublishedFormula) {
    std::mt19937 random(8);
    const Reflectance model = makeModel("ashikhmin-shirley:nu=50,nv=500,rs=0.4,rd=0.6");
    for (int i = 0; i < 200; ++i) {
        const Vec3 wi = randomDirection(random), wo = randomDirection(random), h = halfVector(wi, wo);
        const double c = glm::dot(wi, h), e = (50 * h.x * h.x + 500 * h.y * h.y) / (1 - h.z * h.z);
        const double fresnel = 0.4 + 0.6 * std::pow(1 - c, 5);
        const double specular =
            std::sqrt(51. * 501.) / (8 * kPi) * std::pow(h.z, e) / (c * std::max(wi.z, wo.z)) * fresnel;
        const double diffuse =
            28 * 0.6 / (23 * kPi) * (1 - 0.4) * (1 - std::pow(1 - wi.z / 2, 5)) * (1 - std::pow(1 - wo.z / 2, 5));
        EXPECT_NEAR(model.f(wi, wo).r, specular + diffuse, 1e-9 * (specular + diffuse));
    }
    EXPECT_FALSE(model.microfacet->diffuseIsConstant);
}

TEST(AshikhminShirley,
     DiffuseTermReflectsItsShare) {  // rs = 0, rd = 1: published to integrate to about 1 at normal incidence
    const Reflectance model = makeModel("ashikhmin-shirley:rs=0,rd=1,n=1000000");
    const Rgb a =
        integrateHalfVectors(1, [&](const Vec3& w) { return model.microfacet->diffuse(w, Vec3(0, 0, 1)) * w.z; });
    EXPECT_GT(a.r, 0.9);
    EXPECT_LE(a.r, 1 + kQuadrature);
}

TEST(Schlick, PublishedFormula) {
    std::mt19937 random(9);
    const double r = 0.1, p = 0.4;
    const Reflectance model = makeModel("schlick:r=0.1,p=0.4,f0=0.3");
    for (int i = 0; i < 200; ++i) {
        const Vec3 wi = randomDirection(random), wo = randomDirection(random), h = halfVector(wi, wo);
        const double u = glm::dot(wi, h), t = h.z, v = wi.z, w0 = wo.z, w = std::cos(std::atan2(h.y, h.x));
        const double z = r / sqr(1 + r * t * t - t * t), a = std::sqrt(p / (p * p - p * p * w * w + w * w));
        const double g = v / (r - r * v + v) * w0 / (r - r * w0 + w0), s = 0.3 + 0.7 * std::pow(1 - u, 5);
        const double expected = s * g * z * a / (4 * kPi * v * w0);
        EXPECT_NEAR(model.f(wi, wo).r, expected, 1e-9 * expected);
    }
}
