// Light between surfaces, without the first bounce, against closed forms.
#include "shading/multipass/radiosity.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "shading/primitives.hpp"
#include "shadow_meshes.hpp"

namespace nacre {
namespace {

bool always(const Vec3&, const Vec3&) { return true; }

/// A closed body seen from inside, with a lamp in its middle: every bounce is the albedo times the one before.
TEST(Radiosity, InsideASphereBouncesAreAGeometricSeries) {
    const Mesh sphere = test::insideOut(makeSphere(1, 24, 12));
    const Rgb albedo(0.5, 0.2, 0.8);
    const Light lamp{false, Vec3(0), Rgb(4), {}};
    const RadiositySurface surface{sphere, albedo};
    std::vector<double> shares;
    RadiosityOptions options{.left = 1e-4};
    options.progress = [&](const std::string&, double share) { shares.push_back(share); };
    const IndirectLight out = indirectLight({&surface, 1}, {&lamp, 1}, always, options);
    EXPECT_EQ(shares.size(), 1u + static_cast<std::size_t>(out.shots));
    EXPECT_EQ(shares.front(), 0);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
    ASSERT_EQ(out.radiance.size(), 1u);
    ASSERT_EQ(out.radiance[0].size(), sphere.positions.size());
    double sum[3]{};
    for (const glm::vec3& r : out.radiance[0])
        for (int c = 0; c < 3; ++c) sum[c] += r[c] / static_cast<double>(out.radiance[0].size());
    for (int c = 0; c < 3; ++c) {
        const double direct = 4 * albedo[c] / kPi, indirect = direct * albedo[c] / (1 - albedo[c]);
        EXPECT_NEAR(sum[c], indirect, 0.05 * indirect) << c;  // facets, and vertices that are not spread evenly
    }
}

TEST(Radiosity, OneFlatSurfaceHasNoSecondBounce) {
    const RadiositySurface surface{makeQuad(2, 4), Rgb(0.9)};
    const Light lamp{false, {0, 0, 2}, Rgb(5), {}};
    const IndirectLight out = indirectLight({&surface, 1}, {&lamp, 1}, always);
    for (const glm::vec3& r : out.radiance[0]) EXPECT_EQ(r, glm::vec3(0));
}

TEST(Radiosity, WhatIsHiddenGetsNothing) {
    const RadiositySurface surface{test::insideOut(makeSphere(1, 16, 8)), Rgb(0.5)};
    const Light lamp{false, Vec3(0), Rgb(4), {}};
    const auto never = [](const Vec3&, const Vec3&) { return false; };
    const IndirectLight out = indirectLight({&surface, 1}, {&lamp, 1}, never);
    EXPECT_EQ(out.shots, 0);
    for (const glm::vec3& r : out.radiance[0]) EXPECT_EQ(r, glm::vec3(0));
}

TEST(Radiosity, NothingAndDarknessAreFine) {
    EXPECT_TRUE(indirectLight({}, {}, always).radiance.empty());
    const RadiositySurface surface{makeQuad(1, 1), Rgb(0.5)};
    EXPECT_EQ(indirectLight({&surface, 1}, {}, always).shots, 0);
}

TEST(Radiosity, RejectsAlbedosThatGiveMoreThanTheyGet) {
    const RadiositySurface surface{makeQuad(1, 1), Rgb(1)};
    EXPECT_THROW(indirectLight({&surface, 1}, {}, always), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
