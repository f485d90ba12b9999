#include "factorize/micro/micro.hpp"

#include <gmock/gmock.h>

#include "core/directions.hpp"
#include "core/sampling.hpp"
#include "factorize/micro/gonioreflectometer.hpp"
#include "tests/factorize/measured/measured_support.hpp"

namespace nacre {
namespace {

using namespace nacre::test;
using testing::HasSubstr;

Rgb albedo(const BrdfFunction& f, const Vec3& wi) {
    constexpr std::uint64_t kSamples = 8192;
    Rgb sum(0);
    for (std::uint64_t i = 1; i <= kSamples; ++i)
        sum += f(wi, cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)}));
    return sum * (kPi / kSamples);
}
Vec3 at(double thetaDeg, double phiDeg) { return sphericalDirection(thetaDeg * kPi / 180, phiDeg * kPi / 180); }

// ---- the tracer

TEST(MicroTracer, RaysOverRidgesHitWhereTheProfileSays) {
    const HeightField field = ridges({.slope = 1, .peak = 0.5, .left = Rgb(1), .right = Rgb(0)}, 64);  // height 0.5
    const std::vector<Facet> facets = facetsOf(field);
    const SurfaceTracer tracer = makeTracer(field);
    for (std::size_t p = 0; p < facets.size(); ++p) {
        const Vec3 from = facets[p].centre;
        for (double thetaDeg = -89; thetaDeg < 90; thetaDeg += 7.3)
            for (double phiDeg = -60; phiDeg <= 60; phiDeg += 30) {
                const Vec3 d = at(thetaDeg, phiDeg);
                if (dot(d, facets[p].normal) < 1e-6) continue;
                // By hand: the ray escapes exactly when it clears the crest it points at. Crests at x = 0.5 + k.
                const double crest = d.x > 0 ? (from.x < 0.5 ? 0.5 : 1.5) : (from.x > 0.5 ? 0.5 : -0.5);
                const double height = from.z + d.z * (crest - from.x) / d.x;
                if (std::abs(height - 0.5) < 1e-6) continue;
                EXPECT_EQ(tracer.escapes(from, d), height > 0.5) << p << ' ' << thetaDeg << ' ' << phiDeg;
                const std::ptrdiff_t hit = tracer.firstHit(from, d);
                if (hit >= 0) {
                    EXPECT_LT(dot(d, facets[static_cast<std::size_t>(hit)].normal), 0);
                }
            }
    }
}

/// Distance along the ray to the plane piece over cell (x, y), the x or the y side of its diagonal; infinite for none.
double distanceToTriangle(const HeightField& field, int x, int y, bool ySide, const Vec3& from, const Vec3& d) {
    const auto corner = [&](int i, int j) {
        const int n = field.columns, wrapped = ((j % n + n) % n) * n + (i % n + n) % n;
        return Vec3(i, j, n * field.heights[static_cast<std::size_t>(wrapped)]) / static_cast<double>(n);
    };
    const Vec3 a = corner(x, y), b = ySide ? corner(x, y + 1) : corner(x + 1, y), c = corner(x + 1, y + 1);
    const Mat3 system(b - a, c - a, -d);  // a + u (b − a) + v (c − a) = from + t d
    const Vec3 uvt = glm::inverse(system) * (from - a);
    const bool inside = uvt.x >= 0 && uvt.y >= 0 && uvt.x + uvt.y <= 1 && uvt.z > 1e-9;
    return inside ? uvt.z : std::numeric_limits<double>::infinity();
}

TEST(MicroTracer, BumpsAgreeWithEveryTriangleTried) {
    constexpr int kCells = 6;
    HeightField field = gaussianBumps({}, kCells);
    for (std::size_t i = 0; i < field.heights.size(); ++i) field.heights[i] += 0.3 * radicalInverse(i + 1, 3);
    const std::vector<Facet> facets = facetsOf(field);
    const SurfaceTracer tracer = makeTracer(field);
    int hits = 0;
    for (std::size_t p = 0; p < facets.size(); p += 5)
        for (std::uint64_t i = 1; i <= 40; ++i) {
            const Vec3 d =
                at(20 + 55 * radicalInverse(i, 2), 360 * radicalInverse(i, 3));  // reaches 0.6 tan 75° = 2.2 periods
            if (dot(d, facets[p].normal) < 1e-6) continue;
            double nearest = std::numeric_limits<double>::infinity();
            std::ptrdiff_t expected = -1;
            for (int y = -3 * kCells; y < 4 * kCells; ++y)
                for (int x = -3 * kCells; x < 4 * kCells; ++x)
                    for (const bool ySide : {false, true}) {
                        const double t = distanceToTriangle(field, x, y, ySide, facets[p].centre, d);
                        if (t >= nearest) continue;
                        nearest = t;
                        expected =
                            2 * ((y + 3 * kCells) % kCells * kCells + (x + 3 * kCells) % kCells) + (ySide ? 1 : 0);
                    }
            EXPECT_EQ(tracer.firstHit(facets[p].centre, d), expected) << p << ' ' << i;
            hits += expected >= 0;
        }
    EXPECT_GT(hits, 40);  // 47
}

TEST(MicroTracer, FacetsCoverThePeriodAndBumpsMeet) {
    for (const HeightField& field : {flatField(Rgb(0.5)), ridges({}, 16), gaussianBumps({}, 16)}) {
        double projected = 0;
        Vec3 closed(0);
        for (const Facet& facet : facetsOf(field)) {
            projected += facet.area * facet.normal.z;
            closed += facet.area * facet.normal;
        }
        const double period = static_cast<double>(field.rows) / field.columns;
        EXPECT_NEAR(projected, period, 1e-12);
        EXPECT_NEAR(closed.x, 0, 1e-12);  // as much rises as falls
        EXPECT_NEAR(closed.y, 0, 1e-12);
    }
}

TEST(MicroTracer, GrazingAndHorizontalRaysEnd) {
    const HeightField field = gaussianBumps({}, 16);
    const SurfaceTracer tracer = makeTracer(field);
    for (const Facet& facet : facetsOf(field))
        for (double phi = 0; phi < 6; phi += 0.5)
            for (double z : {0.0, 1e-9, -1e-9}) {
                const Vec3 d = glm::normalize(Vec3(std::cos(phi), std::sin(phi), z));
                if (dot(d, facet.normal) > 0) {
                    EXPECT_EQ(tracer.escapes(facet.centre, d), tracer.firstHit(facet.centre, d) < 0);
                }
            }
}

// ---- the table

TEST(DirectionTable, SquareAndDirectionAreInverse) {
    for (double u = 0; u <= 1; u += 0.0289)
        for (double v = 0; v <= 1; v += 0.0289) {
            const Vec2 back = directionToSquare(squareToDirection({u, v}));
            EXPECT_NEAR(back.x, u, 1e-12) << u << ' ' << v;
            EXPECT_NEAR(back.y, v, 1e-12) << u << ' ' << v;
        }
    for (const double phiDeg : {0, 45, 90, 137, 180, 270, 359}) {  // no seam, held beyond the table
        const Vec2 edge = directionToSquare(at(87, phiDeg)), beyond = directionToSquare(at(89.9, phiDeg));
        EXPECT_NEAR(glm::length(edge - beyond), 0, 1e-12);
        EXPECT_LT(glm::length(directionToSquare(at(60, phiDeg - 0.01)) - directionToSquare(at(60, phiDeg + 0.01))),
                  1e-3);
    }
}

// ---- the simulation

constexpr double kStored = 1e-7;  // single precision

TEST(Micro, FlatFieldIsExactlyLambert) {
    const Reflectance flat = openMicro("micro:flat,albedo=0.2/0.5/1");
    EXPECT_EQ(openMicro(flat.source).hash, flat.hash);
    for (const DirectionPair& pair : samplePairs(2000, 89.9 * kPi / 180)) {
        const Rgb f = flat.f(pair.wi, pair.wo);
        EXPECT_NEAR(f.r, 0.2 / kPi, kStored);
        EXPECT_NEAR(f.g, 0.5 / kPi, kStored);
        EXPECT_NEAR(f.b, 1 / kPi, kStored);
    }
    EXPECT_EQ(flat.f({1, 0, 0}, {0, 0, 1}), Rgb(0));
    EXPECT_EQ(flat.f({0, 0, 1}, {0.6, 0, -0.8}), Rgb(0));
    // The same through facets: a relief of slope 0.
    EXPECT_NEAR(openMicro("micro:ridges,slope=0,left=0.5,right=0.5,resolution=8").f(at(40, 10), at(70, 100)).g,
                0.5 / kPi, kStored);
}

TEST(Micro, OneFaceSeenAloneFollowsItsClosedForm) {  // no bounce: f = ρ n·wi n·wo a/(π A cosθi cosθo), unshadowed
    const HeightField field = ridges({.slope = 0.5, .peak = 0.5, .left = Rgb(0.6), .right = Rgb(0)}, 64);
    const GonioreflectometerOptions options{.resolution = 17, .bounces = 0};
    const DirectionTable table = simulateReflectance(facetsOf(field), makeTracer(field), options);
    const Vec3 normal = glm::normalize(Vec3(-0.5, 0, 1));
    for (std::size_t i = 0; i < 289; i += 3)
        for (std::size_t o = 0; o < 289; o += 7) {
            const Vec3 wi = nodeDirection(17, i), wo = nodeDirection(17, o);
            if (wi.z < 0.55 || wo.z < 0.55) continue;  // slope ≤ 0.5 both ways: nothing is hidden
            const double expected = 0.6 * dot(normal, wi) * dot(normal, wo) * 0.5 / normal.z / (kPi * wi.z * wo.z);
            EXPECT_NEAR(table.values[i * 289 + o].r, expected, 1e-6) << i << ' ' << o;
        }
}

TEST(Micro, BlueFromOneSideRedFromTheOther) {
    const Reflectance r = openMicro("micro:ridges,slope=1,left=0.1/0.2/0.8,right=0.8/0.1/0.1");
    EXPECT_EQ(r.kind, "micro");
    EXPECT_FALSE(r.isotropic);
    EXPECT_THAT(r.source, HasSubstr("micro:ridges,slope=1,peak=0.5,left=0.1/0.2/0.8,right=0.8/0.1/0.1,bounces="));
    const Rgb fromLeft = r.f(at(0, 0), at(60, 180)), fromRight = r.f(at(0, 0), at(60, 0));
    EXPECT_GT(fromLeft.b, 4 * fromLeft.r);
    EXPECT_GT(fromRight.r, 4 * fromRight.b);
    const Rgb along = r.f(at(0, 0), at(60, 90));  // both faces
    EXPECT_NEAR(along.r / along.b, 1, 0.1);
}

TEST(Micro, ReciprocalFinitePositive) {
    for (const char* text :
         {"micro:ridges,peak=0.3,slope=2,resolution=16", "micro:gaussian-bumps,height=0.5,resolution=10"}) {
        const Reflectance r = openMicro(text);
        for (const DirectionPair& pair : samplePairs(2000, 89.9 * kPi / 180)) {
            const Rgb there = r.f(pair.wi, pair.wo), back = r.f(pair.wo, pair.wi);
            ASSERT_TRUE(isFinite(there) && std::min({there.r, there.g, there.b}) >= 0);
            EXPECT_LT(glm::length(there - back), 1e-9 + 1e-9 * glm::length(there));
        }
    }
}

TEST(Micro, EnergyIsConservedAndWhiteStaysWhite) {
    // Shares of the light between facets come from 64 rays, the sky from 256 directions: they agree to 2 %.
    constexpr double kTransport = 0.03;
    const Reflectance white = openMicro("micro:ridges,slope=1,left=1,right=1,bounces=32,resolution=16");
    const Reflectance once = openMicro("micro:ridges,slope=1,left=1,right=1,bounces=0,resolution=16");
    for (const double thetaDeg : {0, 30, 60, 80})
        for (const double phiDeg : {0, 50, 90}) {
            const double all = albedo(white.f, at(thetaDeg, phiDeg)).g;
            EXPECT_NEAR(all, 1, kTransport) << thetaDeg << ' ' << phiDeg;
            EXPECT_LT(albedo(once.f, at(thetaDeg, phiDeg)).g, all - 0.05) << thetaDeg << ' ' << phiDeg;
        }
    const Reflectance bumps = openMicro("micro:gaussian-bumps,height=0.5,left=1,right=1,resolution=16");
    for (const double thetaDeg : {0, 45, 75}) EXPECT_LE(albedo(bumps.f, at(thetaDeg, 20)).g, 1 + kTransport);
}

TEST(Micro, SameBitsForAnyThreadCount) {
    const HeightField field = gaussianBumps({}, 12);
    const auto table = [&](unsigned threads) {
        return simulateReflectance(facetsOf(field), makeTracer(field), {.resolution = 8, .threads = threads}).values;
    };
    EXPECT_EQ(table(1), table(7));
}

TEST(Micro, UnknownReliefsAndParametersListTheKnown) {
    const auto complaint = [](const std::string& text) {
        return messageOf<std::invalid_argument>([&] { openMicro(text); });
    };
    EXPECT_THAT(complaint("micro:waves"), HasSubstr("known: micro:flat, micro:ridges, micro:gaussian-bumps"));
    EXPECT_THAT(complaint("micro:height.png"), HasSubstr("known: micro:flat, micro:ridges, micro:gaussian-bumps"));
    EXPECT_THAT(complaint("micro:"), HasSubstr("known: micro:flat, micro:ridges, micro:gaussian-bumps"));
    EXPECT_THAT(complaint("micro:ridges,height=1"), HasSubstr("known: slope, peak, left, right, bounces, resolution"));
    EXPECT_THAT(complaint("micro:flat,albedo=2"), HasSubstr("micro:flat: albedo=2 is not in [0, 1]"));
    EXPECT_THAT(complaint("micro:flat,resolution=8.5"), HasSubstr("not a whole number"));
    EXPECT_EQ(listMicro().size(), 3u);
    EXPECT_EQ(openReflectance("micro:flat").kind, "micro");
    HeightField bad = flatField(Rgb(0.5));
    bad.albedo[0].g = 1.5;
    EXPECT_THROW(facetsOf(bad), std::invalid_argument);
    bad.albedo.clear();
    EXPECT_THROW(facetsOf(bad), std::invalid_argument);
    EXPECT_THROW(simulateReflectance({}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
