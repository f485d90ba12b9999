// Every method on inputs it is made for, with small tables, so that the suite stays quick; the bars at full
// size are bench's (`nacre_bench --bars`). Errors here are a plain mean over a few thousand pairs, not reference/'s
// metric.
#include "factorize/factorize.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/sampling.hpp"
#include "factorize/models/models.hpp"

namespace nacre {
namespace {

using testing::HasSubstr;

/// √(Σ(f̂−f)² cosines / Σf² cosines) over cosine-distributed pairs within `cosLowest` of the horizon.
double relativeError(const FactoredBrdf& brdf, const BrdfFunction& f, double cosLowest = 0.17) {
    double gap = 0, total = 0;
    for (std::uint64_t i = 1; i < 6000; ++i) {
        const Vec3 wi = cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)});
        const Vec3 wo = cosineHemisphere({radicalInverse(i, 5), radicalInverse(i, 7)});
        if (wi.z < cosLowest || wo.z < cosLowest) continue;
        const Rgb truth = f(wi, wo), d = evaluate(brdf, wi, wo) - truth;
        gap += glm::dot(d, d);
        total += glm::dot(truth, truth);
    }
    return std::sqrt(gap / total);
}

FactoredBrdf bake(const std::string& model, const std::string& method, int size = 0) {
    FactorizeOptions options;
    options.method = method;
    options.size = size;
    return factorize(makeModel(model), options);
}

struct MethodCase {
    const char *model, *method;
    int size;
    double error;  ///< bound, about twice what was measured
};

class EveryMethod : public testing::TestWithParam<MethodCase> {};

TEST_P(EveryMethod, MeetsItsErrorAndIsFiniteAtTheHorizon) {
    const auto& [model, method, size, error] = GetParam();
    const FactoredBrdf brdf = bake(model, method, size);
    EXPECT_LT(relativeError(brdf, makeModel(model).f), error);
    const Vec3 low = glm::normalize(Vec3(1, 0.2, 0.0017)), high = glm::normalize(Vec3(-0.1, 0.3, 0.9));
    for (const auto& [wi, wo] : {std::pair(low, high), {high, low}, {low, low}, {low, low * Vec3(-1, -1, 1)}})
        EXPECT_TRUE(isFinite(evaluate(brdf, wi, wo))) << method;
    EXPECT_EQ(evaluate(brdf, Vec3(1, 0, 0), high), Rgb(0));
}

INSTANTIATE_TEST_SUITE_P(
    Factorize, EveryMethod,
    testing::Values(MethodCase{"torrance-sparrow:alpha=0.3", "analytic", 32, 0.01},
                    MethodCase{"torrance-sparrow:alpha=0.5,f=conductor,eta=0.2/0.9/1.1,k=3.9/2.4/2.2,kd=0.1/0.2/0.3",
                               "analytic", 32, 0.01},
                    MethodCase{"torrance-sparrow:alpha=0.5", "cosine", 64, 0.05},
                    MethodCase{"torrance-sparrow:alpha=0.3,kd=0.2/0.1/0.05", "fit", 32, 0.02},
                    MethodCase{"ggx:alphax=0.2,alphay=0.5", "homomorphic", 48, 0.01},
                    MethodCase{"ward:alphax=0.2,alphay=0.4", "homomorphic", 48, 0.01},
                    MethodCase{"ashikhmin-shirley:nu=10,nv=50", "homomorphic", 48, 0.02},
                    MethodCase{"torrance-sparrow:alpha=0.5", "svd", 24, 0.03},
                    MethodCase{"phong:n=50", "single-lobe", 128, 0.01},
                    MethodCase{"blinn-phong:n=100,ambient=0.1", "single-lobe", 128, 0.01},
                    MethodCase{"cosine-lobe", "single-lobe", 128, 0.01}, MethodCase{"banks", "tangent", 128, 0.02}));

TEST(Factorize, AutoTakesTheFormThatFitsTheModel) {
    EXPECT_EQ(bake("torrance-sparrow:alpha=0.2", "auto").method, "analytic");
    EXPECT_EQ(bake("phong", "auto").method, "single-lobe");
    EXPECT_EQ(bake("banks", "auto").method, "tangent");
    EXPECT_EQ(bake("ward:alphax=0.1,alphay=0.3", "auto").method, "homomorphic");
}

TEST(Factorize, HardParametersStayFinite) {
    const Vec3 n(0, 0, 1), low = glm::normalize(Vec3(1, 0, 0.0017));
    for (const char* model : {"torrance-sparrow:alpha=0.001", "torrance-sparrow:alpha=1", "torrance-sparrow:eta=1",
                              "torrance-sparrow:eta=200", "blinn-phong:n=1000000", "phong:n=0",
                              "ggx:alphax=0.001,alphay=1", "lambert:kd=0"}) {
        const FactoredBrdf brdf = bake(model, "auto");
        for (const AssetTexture& texture : brdf.textures)
            for (float v : texture.image.data()) ASSERT_TRUE(std::isfinite(v)) << model;
        for (const Vec3& wi : {n, low})
            for (const Vec3& wo : {n, low}) EXPECT_TRUE(isFinite(evaluate(brdf, wi, wo))) << model;
    }
}

TEST(Factorize, HalfOverflowIsScaledNotClipped) {  // peak of D at alpha 1e-3: 3e5 > 65504
    const FactoredBrdf brdf = bake("torrance-sparrow:alpha=0.001,f=none", "cosine", 32);
    const Rgb peak = evaluate(brdf, Vec3(0, 0, 1), Vec3(0, 0, 1));
    const Rgb truth = makeModel("torrance-sparrow:alpha=0.001,f=none").f(Vec3(0, 0, 1), Vec3(0, 0, 1));
    EXPECT_NEAR(peak.r / truth.r, 1, 2e-3);
}

TEST(Factorize, BlackStaysBlack) {
    Reflectance black;
    black.source = "black";
    black.f = [](const Vec3&, const Vec3&) { return Rgb(0); };
    const FactoredBrdf brdf = factorize(black, {.method = "fit", .size = 16});
    EXPECT_LT(maxComponent(evaluate(brdf, Vec3(0, 0, 1), glm::normalize(Vec3(1, 1, 1)))), 2e-3);
}

TEST(Factorize, NonFiniteInputIsNamed) {
    Reflectance bad;
    bad.source = "bad";
    bad.f = [](const Vec3& wi, const Vec3&) { return Rgb(wi.z > 0.9 ? std::nan("") : 1.0); };
    EXPECT_THROW(factorize(bad, {.method = "fit", .size = 16}), Error);
}

TEST(Factorize, ExplicitSizeAndFormatDecideTheBytes) {
    FactorizeOptions options{.method = "fit", .size = 16};
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.4,kd=0.2");
    EXPECT_EQ(factorize(r, options).bytes(), 2u * 16 * 16 * 4 * 2);
    options.format = TexelFormat::Unorm8;
    const FactoredBrdf small = factorize(r, options);
    EXPECT_EQ(small.bytes(), 2u * 16 * 16 * 4);
    EXPECT_LT(relativeError(small, r.f), 0.1);
    options.terms = 1;
    EXPECT_EQ(factorize(r, options).fetches, 1);
}

FactorizeOptions budget(const Reflectance& r) {
    FactorizeOptions options;
    options.measure = [f = r.f](const FactoredBrdf& b) { return relativeError(b, f); };
    return options;
}

TEST(FactorizeBudget, TakesTheSmallestThatMeetsTheError) {
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.4");
    FactorizeOptions loose = budget(r), tight = budget(r);
    loose.maxError = 0.02;
    tight.maxError = 0.002;
    const FactoredBrdf small = factorize(r, loose), large = factorize(r, tight);
    EXPECT_LE(relativeError(small, r.f), 0.02);
    EXPECT_LE(relativeError(large, r.f), 0.002);
    EXPECT_LT(small.bytes(), large.bytes());
}

TEST(FactorizeBudget, KeepsBytesAndFetches) {
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.4");
    FactorizeOptions options = budget(r);
    options.maxBytes = 9216;
    EXPECT_LE(factorize(r, options).bytes(), 9216u);
    options.maxFetches = 1;
    EXPECT_EQ(factorize(r, options).fetches, 1);
}

TEST(FactorizeBudget, SaysHowNearItCame) {
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.2");
    FactorizeOptions options = budget(r);
    options.maxError = 1e-9;
    options.maxBytes = 5000;
    try {
        factorize(r, options);
        FAIL() << "met an impossible budget";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("nearest"));
        EXPECT_THAT(error.what(), HasSubstr("bytes <= 5000"));
    }
}

/// Counts what a search asks about: each question is a bake.
TEST(FactorizeBudget, ImpossibleErrorCostsFewBakes) {
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.2");
    for (const double maxError : {1e-9, 1e-4}) {  // far off; the smallest two and the largest miss
        FactorizeOptions options = budget(r);
        int bakes = 0;
        options.measure = [&, inner = options.measure](const FactoredBrdf& b) { return ++bakes, inner(b); };
        options.method = "fit";
        options.terms = 1;  // one ladder
        options.maxError = maxError;
        EXPECT_THROW(factorize(r, options), Error);
        EXPECT_LE(bakes, 4) << maxError;
    }
}

TEST(FactorizeBudget, NearestTriedIsNoFartherThanTheUsualSize) {
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.2");
    FactorizeOptions options = budget(r);
    options.method = "analytic";
    options.maxError = 1e-9;
    try {
        factorize(r, options);
        FAIL() << "met an impossible budget";
    } catch (const Error& error) {
        const double usual = relativeError(bake("torrance-sparrow:alpha=0.2", "analytic"), r.f);
        EXPECT_THAT(error.what(), HasSubstr(fmt::format("nearest tried: analytic with error {:.4g}, 16384 b", usual)));
    }
}

TEST(FactorizeBudget, SmallBudgetsAreMet) {
    struct Case {
        const char *model, *method;
        std::size_t maxBytes;
        double error;
    };
    for (const auto& [model, method, maxBytes, error] :
         {Case{"ggx:alphax=0.1,alphay=0.4", "auto", 1000, 0.01}, Case{"lambert", "auto", 2047, 0.001},
          Case{"phong", "single-lobe", 500, 0.01}, Case{"torrance-sparrow:alpha=0.1", "auto", 1000, 0.1},
          Case{"torrance-sparrow:alpha=0.3,kd=0.2", "fit", 1000, 0.1}}) {
        const Reflectance r = makeModel(model);
        FactorizeOptions options = budget(r);
        options.method = method;
        options.maxBytes = maxBytes;
        const FactoredBrdf small = factorize(r, options);
        EXPECT_LE(small.bytes(), maxBytes) << model;
        EXPECT_LT(relativeError(small, r.f), error) << model;
    }
}

TEST(FactorizeBudget, SmallestThatIsNamedCanBeHad) {  // and one byte less can't
    const Reflectance r = makeModel("phong");
    FactorizeOptions options = budget(r);
    options.method = "single-lobe";
    options.maxBytes = 4 * 2 * 3 * 2;  // 4 × 2 texels, RGB, half floats
    EXPECT_EQ(factorize(r, options).bytes(), options.maxBytes);
    --*options.maxBytes;
    try {
        factorize(r, options);
        FAIL() << "met an impossible budget";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("of the sizes tried the smallest takes 48 bytes or more"));
    }
}

/// Two colours that no isotropic method takes, as cheap to ask as a formula.
Reflectance relief() {
    Reflectance r;
    r.source = "relief";
    r.isotropic = false;
    r.f = [](const Vec3& wi, const Vec3& wo) {
        return wi.z > 0 && wo.z > 0 ? Rgb(1 + wi.x) * Rgb(1 + wo.x) + Rgb(1 - wi.y) * Rgb(0, 1 - wo.y, 0) : Rgb(0);
    };
    return r;
}

TEST(FactorizeBudget, TwoFetchesAreOneTermOfTheSvd) {
    const Reflectance r = relief();
    FactorizeOptions options = budget(r);
    options.method = "svd";
    options.parametrization = "symmetric";
    options.maxFetches = 2;
    EXPECT_EQ(factorize(r, options).fetches, 2);
    options.maxFetches = 1;
    EXPECT_THROW(factorize(r, options), Error);
}

TEST(FactorizeBudget, FetchesAloneChangeNothingThatKeepsThem) {
    const Reflectance r = relief();
    FactorizeOptions options = budget(r);
    options.method = "svd";
    options.parametrization = "symmetric";
    options.terms = 1;
    const FactoredBrdf usual = factorize(r, options);
    options.maxFetches = 2;
    const FactoredBrdf bounded = factorize(r, options);
    EXPECT_EQ(bounded.bytes(), usual.bytes());
    EXPECT_EQ(relativeError(bounded, r.f), relativeError(usual, r.f));
}

TEST(FactorizeBudget, BoundsThatNothingMeetsFailBeforeAnyBake) {
    Reflectance r = makeModel("torrance-sparrow:alpha=0.2");
    r.f = [](const Vec3&, const Vec3&) -> Rgb { throw std::logic_error("something was baked"); };
    for (const bool withError : {false, true}) {
        FactorizeOptions bytes = budget(r), fetches = budget(r);
        if (withError) bytes.maxError = fetches.maxError = 0.01;
        bytes.maxBytes = 50;
        fetches.maxFetches = 0;
        for (const FactorizeOptions& options : {bytes, fetches}) try {
                factorize(r, options);
                FAIL() << "met an impossible budget";
            } catch (const Error& error) {
                EXPECT_THAT(error.what(),
                            HasSubstr("the smallest takes 64 bytes or more, and a lookup 1 fetches or more"));
            }
    }
}

TEST(FactorizeBudget, TermsHoldWithinABudget) {
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.4,kd=0.2");
    FactorizeOptions options = budget(r);
    options.method = "fit";
    options.maxBytes = 10000;
    for (const int terms : {1, 2}) {
        options.terms = terms;
        EXPECT_EQ(factorize(r, options).fetches, terms) << "Compact, then Grazing";
    }
}

TEST(Factorize, OptionsThatTheMethodLacksAreRefused) {
    const Reflectance r = makeModel("torrance-sparrow:alpha=0.4");
    const auto complaint = [&](const FactorizeOptions& options) -> std::string {
        try {
            factorize(r, options);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(complaint({.method = "analytic", .terms = 2}), "terms: only fit and svd take it, found method analytic");
    EXPECT_EQ(complaint({.method = "fit", .parametrization = "in_out"}),
              "parametrization: only svd takes it, found method fit");
    EXPECT_EQ(complaint({.parametrization = "in_out"}),
              "parametrization: only svd takes it, found method auto, which chooses among analytic, fit here");
    EXPECT_EQ(factorize(r, {.size = 16, .terms = 1}).method, "fit") << "auto turns to a method that has terms";
    EXPECT_FALSE(unusedOption({.method = "svd", .terms = 1, .parametrization = "in_out"}));
}

TEST(Factorize, RejectsWhatDoesNotFit) {
    const Reflectance anisotropic = makeModel("ward:alphax=0.1,alphay=0.3");
    EXPECT_THROW(factorize(anisotropic, {.method = "fit"}), std::invalid_argument);
    EXPECT_THROW(factorize(anisotropic, {.method = "analytic"}), std::invalid_argument);
    EXPECT_THROW(factorize(anisotropic, {.method = "homomorphic", .size = 1}), std::invalid_argument);
    try {
        factorize(anisotropic, {.method = "magic"});
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), HasSubstr("known: auto, analytic"));
    }
}

TEST(FactoredBrdf, AssetRoundTripKeepsEveryValue) {
    const FactoredBrdf brdf = bake("ashikhmin-shirley:nu=10,nv=50", "homomorphic", 16);
    const FactoredBrdf back = factoredFromAsset(toAsset(brdf), "memory");
    for (std::uint64_t i = 1; i < 200; ++i) {
        const Vec3 wi = cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)});
        const Vec3 wo = cosineHemisphere({radicalInverse(i, 5), radicalInverse(i, 7)});
        EXPECT_EQ(evaluate(brdf, wi, wo), evaluate(back, wi, wo));
    }
}

TEST(FactoredBrdf, RejectsAssetsThatLackParts) {
    Asset asset = toAsset(bake("phong", "single-lobe", 16));
    asset.kind = "bump";
    EXPECT_THROW(factoredFromAsset(asset, "x.exr"), Error);
    asset.kind = "brdf";
    asset.textures.clear();
    EXPECT_THROW(factoredFromAsset(asset, "x.exr"), Error);
    asset.meta.erase("form");
    EXPECT_THROW(factoredFromAsset(asset, "x.exr"), Error);
}

TEST(FactoredBrdf, RejectsALayoutItDoesNotKnow) {
    Asset asset = toAsset(bake("torrance-sparrow:alpha=0.5", "cosine", 16));
    asset.meta["form"] = "half_diff";
    for (const double layout : {4.0, -1.0, 0.5}) {
        asset.meta["params"][0][1] = layout;
        EXPECT_THROW(factoredFromAsset(asset, "x.exr"), Error) << layout;
    }
    asset.meta["params"][0][1] = 0.0;
    EXPECT_NO_THROW(factoredFromAsset(asset, "x.exr"));
}

}  // namespace
}  // namespace nacre
