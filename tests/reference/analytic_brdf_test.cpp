#include "reference/analytic_brdf.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/directions.hpp"
#include "core/sampling.hpp"
#include "factorize/models/models.hpp"
#include "reference/albedo.hpp"
#include "reference/pair_sampling.hpp"

using namespace nacre;

namespace {

// Both sides are double precision; an exponent of −700 or 1e6 turns an angle's rounding into this. Measured 6e-10.
constexpr double kTwoFormulas = 1e-8;

const std::vector<std::string> kModels = {
    "lambert:kd=0.2/0.5/0.9",
    "phong:n=0",
    "phong:kd=0.1,ks=0.3/0.4/0.5,n=20.5",
    "phong:n=1e6",
    "blinn-phong:n=0",
    "blinn-phong:kd=0.1,ks=0.3/0.4/0.5,n=77",
    "blinn-phong:n=1e6",
    "cosine-lobe:n=8,cx=-0.7,cy=0.4,cz=0.9",
    "cosine-lobe:n=3,cx=0.2,cy=1,cz=-0.5",
    "torrance-sparrow:d=beckmann,g=smith,alpha=0.1,f=conductor,eta=0.2/0.9/1.4,k=3.9/2.5/2.3",
    "torrance-sparrow:d=beckmann,alpha=0.001",
    "torrance-sparrow:d=beckmann,alpha=1,kd=0.3",
    "torrance-sparrow:d=ggx,alpha=0.3,f=schlick,f0=0.9/0.5/0.1",
    "torrance-sparrow:d=ggx,alpha=0.001,f=none",
    "torrance-sparrow:d=gaussian,alpha=0.2,eta=200",
    "torrance-sparrow:d=gaussian,alpha=1,eta=0.7",
    "torrance-sparrow:d=beckmann,g=v-cavity,alpha=0.4,eta=1.5,ks=0.5/0.6/0.7",
    "torrance-sparrow:eta=1",
    "cook-torrance:d=gaussian,alpha=0.3,f=conductor,eta=1,k=200",
    "ggx:alphax=0.1,alphay=0.4",
    "ggx:alphax=0.9,alphay=0.05,g=smith,f=conductor",
    "ward:variant=ward1992,alphax=0.1,alphay=0.3,kd=0.2",
    "ward:variant=duer,alphax=0.5,alphay=0.05",
    "ward:variant=gmd,alphax=0.2,alphay=0.1",
    "ashikhmin-shirley:nu=50,nv=500,rs=0.3/0.5/0.9,rd=0.5",
    "ashikhmin-shirley:nu=0,nv=1e4",
    "schlick:r=0.04,p=0.3,f0=0.6/0.5/0.4,kd=0.2",
    "schlick:r=1,p=1",
    "schlick:r=0.0001,p=0.05",
    "banks:kd=0.1,ks=0.5,n=30",
    "banks:n=0.5",
};

bool known(const std::string& text) {
    for (const ModelInfo& model : listModels())
        if (model.name == text.substr(0, text.find(':'))) return true;
    return false;
}

/// Pairs over both hemispheres, dense at the peak; and pairs with one or both directions 0.1°, 0.001° from the horizon.
std::vector<DirectionPair> pairs() {
    std::vector<DirectionPair> out;
    for (std::uint64_t n = 0; n < 4000; ++n)
        if (const WeightedPair p = drawPair(n, 4000, 5); p.weight > 0) out.push_back(p.pair);
    for (std::uint64_t n = 1; n < 200; ++n)
        for (const double below : {0.1, 0.001}) {
            const Vec3 u = halton3(n), low = sphericalDirection((90 - below) * kPi / 180, 2 * kPi * u.x);
            const Vec3 other = sphericalDirection(u.y * kPi / 2, 2 * kPi * u.z);
            out.push_back({low, other});
            out.push_back({other, low});
            out.push_back({low, Vec3(-low.x, -low.y, low.z)});
        }
    return out;
}

}  // namespace

TEST(AnalyticBrdf, AgreesWithTheModelsWhereverTheyAreAsked) {
    const std::vector<DirectionPair> all = pairs();
    for (const std::string& text : kModels) {
        if (!known(text)) continue;
        const Reflectance model = makeModel(text);
        const auto truth = referenceBrdf(model.source);
        ASSERT_TRUE(truth) << model.source;
        double worst = 0;
        for (const auto& [wi, wo] : all) {
            const Rgb expected = (*truth)(wi, wo), found = model.f(wi, wo);
            ASSERT_TRUE(isFinite(expected) && isFinite(found)) << text;
            for (int c = 0; c < 3; ++c) {
                ASSERT_GE(expected[c], 0) << text;
                const double error = std::abs(found[c] - expected[c]) / (expected[c] + 1e-12);
                worst = std::max(worst, error);
            }
        }
        EXPECT_LT(worst, kTwoFormulas) << text;
    }
}

TEST(AnalyticBrdf, CoversEveryModelButPublishedFits) {
    for (const ModelInfo& model : listModels())
        EXPECT_EQ(referenceBrdf(makeModel(model.name).source).has_value(), model.name != "sgd") << model.name;
}

TEST(AnalyticBrdf, MicrofacetsWithoutFresnelReflectAllAtNormalIncidence) {
    // Smooth: no masking to lose light by. An error in a constant would show.
    for (const char* text : {"torrance-sparrow:d=beckmann,g=smith,alpha=0.01,f=none,eta=1,k=0,f0=0,ks=1,kd=0",
                             "torrance-sparrow:d=gaussian,g=smith,alpha=0.01,f=none,eta=1,k=0,f0=0,ks=1,kd=0",
                             "ggx:g=smith,alphax=0.001,alphay=0.002,f=none,eta=1,k=0,f0=0,ks=1,kd=0"})
        EXPECT_NEAR(directionalAlbedo(*referenceBrdf(text), Vec3(0, 0, 1), 65536).g, 1, 3e-3) << text;
}

TEST(AnalyticBrdf, HorizonIsBlackAndOtherSourcesAreNotOurs) {
    const auto f = referenceBrdf("lambert:kd=0.5");
    EXPECT_EQ((*f)(Vec3(1, 0, 0), Vec3(0, 0, 1)), Rgb(0));
    EXPECT_EQ((*f)(Vec3(0, 0, 1), Vec3(0, 0, -1)), Rgb(0));
    EXPECT_FALSE(referenceBrdf("sgd:material=gold-paint"));
    EXPECT_FALSE(referenceBrdf("folder/table.binary"));
    EXPECT_THROW(referenceBrdf("phong:kd=0,ks=1"), std::invalid_argument);
    EXPECT_THROW(referenceBrdf("lambert:kd=x"), std::invalid_argument);
    EXPECT_THROW(referenceBrdf("lambert:kd=0.1/0.2"), std::invalid_argument);
}
