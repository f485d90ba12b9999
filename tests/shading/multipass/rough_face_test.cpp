// What facets do to a view: against plain cases, without OpenGL.
#include "shading/multipass/rough_face.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

constexpr Plane kFloor{0, 1, 0, 0};

TEST(RoughFace, AFacetLikeTheFaceChangesNothing) {
    for (const std::optional<double> eta : {std::optional<double>(), {1.5}, {1 / 1.5}})
        for (const Vec3& v : {Vec3(0, 1, 0), glm::normalize(Vec3(0.3, 1, -0.2)), glm::normalize(Vec3(0.3, -1, -0.2))}) {
            const FacetShear shear = facetShear(v, kFloor, eta, 0.2, Vec2(0));
            EXPECT_NEAR(glm::length(shear.slope), 0, 1e-12);
            EXPECT_NEAR(shear.weight, 1, 1e-12);
        }
}

/// Seen from above, a facet that leans by a small slope s turns a mirrored ray by 2 s and a refracted one by
/// (1 − 1/η) s: the shear moves the world the other way.
TEST(RoughFace, SmallSlopesAsLinear) {
    const double s = 1e-4, alpha = s / std::sqrt(0.5);
    const FacetShear mirror = facetShear({0, 1, 0}, kFloor, {}, alpha, {1, 0});
    EXPECT_NEAR(std::abs(mirror.slope.x), 2 * s, 1e-7);
    EXPECT_NEAR(mirror.slope.y, 0, 1e-12);
    const FacetShear glass = facetShear({0, 1, 0}, kFloor, 1.5, alpha, {0, 1});
    EXPECT_NEAR(std::abs(glass.slope.y), s / 3, 1e-7);
    const FacetShear none = facetShear(glm::normalize(Vec3(1, 1, 0)), kFloor, 1.0, alpha, {1, 1});
    EXPECT_NEAR(glm::length(none.slope), 0, 1e-12) << "index 1 turns no ray";
}

/// A view that is sheared has the ray of the incident angle where the facet sends it.
TEST(RoughFace, TheIncidentRayGoesWhereTheFacetSendsIt) {
    const Vec3 eye(0.5, 2, 1), at(0, 0, 0), v = glm::normalize(eye - at);
    const Vec2 g(0.8, -1.1);
    const FacetShear shear = facetShear(v, kFloor, {}, 0.3, g);
    const Vec3 below(eye.x, -eye.y, eye.z);  // the mirrored eye
    const Vec3 moved(shearedEye(Vec4(below, 1), kFloor, shear.slope));
    const Vec3 x = planeAxis(kFloor);
    const Vec3 facet =
        glm::normalize(Vec3(0, 1, 0) + 0.3 * std::sqrt(0.5) * (g.x * x + g.y * glm::cross(Vec3(0, 1, 0), x)));
    const Vec3 expected = 2 * glm::dot(v, facet) * facet - v;
    EXPECT_NEAR(glm::length(glm::cross(glm::normalize(at - moved), expected)), 0, 1e-12);
}

TEST(RoughFace, HardCases) {
    EXPECT_EQ(facetShear({1, 0, 0}, kFloor, {}, 0.3, {1, 1}).weight, 0) << "along the face";
    EXPECT_EQ(facetShear(glm::normalize(Vec3(1, 0.05, 0)), kFloor, 1 / 1.5, 0.3, {0, 0}).weight, 0)
        << "total reflection";
    double away = 0;
    for (const Vec2& g : {Vec2(9, 0), Vec2(-9, 0), Vec2(0, 9), Vec2(0, -9)})
        away += facetShear(glm::normalize(Vec3(1, 0.2, 0.3)), kFloor, {}, 1, g).weight == 0;
    EXPECT_GE(away, 1) << "facets that lean away or send the ray below";
}

}  // namespace
}  // namespace nacre
