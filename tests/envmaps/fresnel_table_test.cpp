// Fresnel tables against the complex formula of reference/, and the two ways to combine (HSE section 1.5).
#include "envmaps/fresnel_table.hpp"

#include <gtest/gtest.h>

#include "reference/microfacet_terms.hpp"

namespace nacre {
namespace {

double worstOf(const FresnelIndex& index, int size, TexelFormat format = TexelFormat::Half) {
    const AssetTexture table = bakeFresnelTable(index, size, format);
    double worst = 0;
    for (int i = 0; i <= 5000; ++i) {
        const double theta = kPi / 2 * i / 5000;
        const Rgb found = lookupFresnel(table, std::cos(theta));
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(found[c] - terms::fresnel(theta, index.eta[c], index.k[c])));
    }
    return worst;
}

TEST(FresnelTable, FollowsTheFormula) {  // half floats near 1 err by 2.4e-4
    EXPECT_LT(worstOf({Rgb(1.5), Rgb(0)}, 64), 1e-3);
    EXPECT_LT(worstOf({Rgb(5), Rgb(0)}, 64), 1e-3);
    EXPECT_LT(worstOf({Rgb(200), Rgb(0)}, 256), 4e-3);
    EXPECT_LT(worstOf({Rgb(0.2, 0.92, 1.1), Rgb(3.9, 2.45, 1.8)}, 64), 1e-3);  // gold
}

TEST(FresnelTable, ErrorFallsWithTheSize) {
    EXPECT_LT(worstOf({Rgb(1.5), Rgb(0)}, 64, TexelFormat::Float),
              0.3 * worstOf({Rgb(1.5), Rgb(0)}, 32, TexelFormat::Float));
}

TEST(FresnelTable, ExtremeIndices) {
    for (const double cosine : {0.0, 1e-4, 0.5, 1.0}) {
        EXPECT_EQ(lookupFresnel(bakeFresnelTable({Rgb(1), Rgb(0)}, 16), cosine), Rgb(0));  // no interface
        const Rgb metal = lookupFresnel(bakeFresnelTable({Rgb(200), Rgb(0)}, 256), cosine);
        EXPECT_GT(metal.x, 0.17);  // Brewster's dip: half of s-polarised light and none of p would be 0.5
        EXPECT_LE(metal.x, 1.0);
    }
    EXPECT_NEAR(lookupFresnel(bakeFresnelTable({Rgb(1 / 1.5), Rgb(0)}, 512), 0.3).x, 1, 1e-3);  // total reflection
    EXPECT_EQ(lookupFresnel(bakeFresnelTable({Rgb(1.5), Rgb(0)}, 64), 0).x, 1);                 // grazing
}

TEST(FresnelTable, GreyIndexTakesOneChannel) {
    EXPECT_EQ(bakeFresnelTable({Rgb(1.5), Rgb(0)}, 64).image.channels(), 1);
    EXPECT_EQ(bakeFresnelTable({Rgb(1.5, 1.6, 1.7), Rgb(0)}, 64).image.channels(), 3);
}

TEST(FresnelTable, RejectsBadIndexAndSize) {
    EXPECT_THROW(bakeFresnelTable({Rgb(0), Rgb(0)}, 64), std::invalid_argument);
    EXPECT_THROW(bakeFresnelTable({Rgb(1.5), Rgb(-1)}, 64), std::invalid_argument);
    EXPECT_THROW(bakeFresnelTable({Rgb(NAN), Rgb(0)}, 64), std::invalid_argument);
    EXPECT_THROW(bakeFresnelTable({Rgb(1.5), Rgb(0)}, 1), std::invalid_argument);
}

TEST(FresnelCombination, CoatLetsThroughWhatItDoesNotReflect) {
    const Rgb mirror(2), diffuse(1, 0.5, 0);
    EXPECT_EQ(blendReflection(Rgb(1), mirror, diffuse), mirror);
    EXPECT_EQ(blendReflection(Rgb(0), mirror, diffuse), diffuse);
    EXPECT_EQ(addReflection(Rgb(0.5), mirror, diffuse), Rgb(2, 1.5, 1));
}

}  // namespace
}  // namespace nacre
