// Light in reliefs on the GPU against its CPU twin, which tests/bump measures against traced paths.
#include "shading/gpu_relief_light.hpp"

#include <gtest/gtest.h>

#include "bump/scattered_light.hpp"
#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "tests/bump/relief_fixtures.hpp"

namespace nacre {
namespace {

// Root mean square difference as a share of the twin's root mean square.
constexpr double kHalf = 4e-3;  // half distances move lookups by up to 2^-12 of the distance, across shadows' edges too
constexpr double kFactored = 1e-2;  // a half texture's BRDF, 2e-3, in each of up to four reflections
constexpr double kLargest = 0.1;    // a texel's, of the twin's largest value: where a ray grazes an edge

const Vec3 kLight = glm::normalize(Vec3(0.7, -0.4, 0.6));

void expectTwins(const Image& gpu, const Image& cpu, double tolerance, const std::string& what) {
    double apart = 0, own = 0, largest = 0, worst = 0;
    for (std::size_t i = 0; i < cpu.data().size(); ++i) {
        const double a = gpu.data()[i], b = cpu.data()[i];
        ASSERT_TRUE(std::isfinite(a)) << what;
        apart += sqr(a - b), own += sqr(b);
        largest = std::max(largest, b), worst = std::max(worst, std::abs(a - b));
    }
    EXPECT_GT(own, 0) << what;
    EXPECT_LT(std::sqrt(apart / own), tolerance) << what;
    EXPECT_LT(worst, kLargest * largest) << what;
}

Image scatteredOf(const ScatteredLight& light) {
    Image out = light.sky;
    for (std::size_t i = 0; i < out.data().size(); ++i) out.data()[i] += light.indirect.data()[i];
    return out;
}

Image checkers(int width, int height) {
    Image out(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) out.setRgb(x, y, (x / 4 + y / 4) % 2 ? Rgb(1, 0.2, 0.1) : Rgb(0.3, 0.9, 1));
    return out;
}

struct Scene {
    HeightMap map;
    ScatterMap scatter;
    GpuReliefLightOptions gpu;
    ReliefLamp lamp;
    ScatteredLightOptions cpu;
};

Scene makeScene(Wrap wrap, int bounces) {
    Scene s;
    s.map = roughMap(40, 24, 5, wrap);
    s.map.heights.at(7, 9, 0) = s.map.heights.at(8, 9, 0) = std::nanf("");
    s.scatter = makeScatterMap(s.map, {.directions = 70});
    s.gpu.albedoMap = s.cpu.albedoMap = checkers(40, 24);
    s.gpu.bounces = s.cpu.bounces = bounces;
    s.gpu.paths = s.cpu.paths = 40;
    s.lamp.light = s.cpu.light = kLight;
    s.lamp.irradiance = s.cpu.irradiance = Rgb(3, 2, 1);
    return s;
}

void compare(Scene& s, double tolerance, const std::string& what, GlApi api = GlApi::Core33,
             Glsl dialect = Glsl::V330) {
    test::context(api);
    ProgramLoader loader(dialect);
    GpuReliefLight gpu(loader, s.map, s.scatter, s.gpu);
    gpu.update(s.lamp);
    const ScatteredLight cpu = scatterLight(s.map, s.scatter, s.cpu);
    expectTwins(gpu.read(gpu.scattered()), scatteredOf(cpu), tolerance, what + ", scattered");
    expectTwins(gpu.read(gpu.total()), cpu.total(), tolerance, what + ", total");
}

TEST(GpuReliefLight, LambertIsItsTwin) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
        for (const int bounces : {1, 2, 3, 4}) {
            Scene s = makeScene(wrap, bounces);
            compare(s, kHalf, toString(wrap) + ' ' + std::to_string(bounces));
        }
}

TEST(GpuReliefLight, SkyIsItsTwinWithAndWithoutBounces) {
    for (const int bounces : {0, 3})
        for (const bool lamp : {true, false}) {
            Scene s = makeScene(Wrap::Repeat, bounces);
            s.lamp.sky = s.cpu.sky = [](const Vec3& d) { return Rgb(1 + d.x, d.y > 0 ? 1 : 0, 0.5); };
            if (!lamp) s.lamp.irradiance = s.cpu.irradiance = Rgb(0);
            compare(s, kHalf, "sky " + std::to_string(bounces));
        }
}

TEST(GpuReliefLight, AnEnvironmentIsTheSky) {
    test::context();
    EnvMap map(EnvLayout::Cube, 16);
    const auto radiance = [](const Vec3& d) { return Rgb(1 + d.z, 1 + 0.5 * d.x, 1 - 0.5 * d.y); };
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 16; ++x) map.image.setRgb(x, y, radiance(envTexelDirection(EnvLayout::Cube, 16, x, y)));
    const GpuEnvironment surrounding(map);
    Scene s = makeScene(Wrap::Repeat, 2);
    s.lamp.surrounding = &surrounding;
    s.lamp.toSurrounding = glm::mat3(0, 0, 1, 1, 0, 0, 0, 1, 0);  // x to z, y to x, z to y
    s.cpu.sky = [&](const Vec3& d) { return radiance({d.y, d.z, d.x}); };
    compare(s, 1e-2, "environment");  // a linear function over 16 texels a face
}

TEST(GpuReliefLight, FactoredBrdfIsItsTwin) {
    test::context();
    FactorizeOptions options;
    options.method = "analytic", options.size = 16;
    const FactoredBrdf brdf = factorize(makeModel("ggx:alpha=0.4"), options);
    const GpuFactoredBrdf uploaded(brdf);
    for (const bool sky : {false, true})
        for (const int bounces : {1, 3}) {
            Scene s = makeScene(Wrap::Repeat, bounces);
            s.gpu.brdf = &uploaded, s.gpu.albedo = s.cpu.albedo = Rgb(1);
            s.cpu.brdf = [&](const Vec3& wi, const Vec3& wo) { return evaluate(brdf, wi, wo); };
            s.lamp.viewer = s.cpu.viewer = glm::normalize(Vec3(-0.5, 0.2, 1));
            if (sky) s.lamp.sky = s.cpu.sky = [](const Vec3& d) { return Rgb(0.5 + 0.5 * d.x); };
            compare(s, kFactored, "factored " + std::to_string(bounces));
        }
}

TEST(GpuReliefLight, OtherApis) {
    for (const auto& [api, dialect] : {std::pair(GlApi::Core45, Glsl::V450), {GlApi::Es3, Glsl::Es300}}) {
        Scene s = makeScene(Wrap::Mirror, 2);
        compare(s, kHalf, toString(dialect), api, dialect);
    }
    test::context();
}

TEST(GpuReliefLight, FollowsTheLightAndHardReliefs) {
    test::context();
    ProgramLoader loader;
    Scene s = makeScene(Wrap::Repeat, 2);
    GpuReliefLight gpu(loader, s.map, s.scatter, s.gpu);
    gpu.update(s.lamp);
    s.lamp.light = s.cpu.light = glm::normalize(Vec3(-0.3, 0.8, 0.5));
    gpu.update(s.lamp);
    expectTwins(gpu.read(gpu.total()), scatterLight(s.map, s.scatter, s.cpu).total(), kHalf, "turned");
    s.lamp.light = Vec3(0, 0, -1);
    gpu.update(s.lamp);
    const Image dark = gpu.read(gpu.total());
    for (const float v : dark.data()) EXPECT_EQ(v, 0);
    for (const HeightMap& map : {flatMap(1, 1), roughMap(1, 40, 3), flatMap(5, 3)}) {
        const ScatterMap scatter = makeScatterMap(map, {.directions = 16});
        GpuReliefLight hard(loader, map, scatter, {.paths = 8});
        hard.update({.light = kLight});
        const Image cpu = scatterLight(map, scatter, {.light = kLight, .paths = 8}).total();
        expectTwins(hard.read(hard.total()), cpu, kHalf, "hard");
    }
}

TEST(GpuReliefLight, RejectsBadOptions) {
    test::context();
    ProgramLoader loader;
    const HeightMap map = flatMap(4, 4);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 4});
    EXPECT_THROW(GpuReliefLight(loader, map, scatter, {.bounces = -1}), std::invalid_argument);
    EXPECT_THROW(GpuReliefLight(loader, map, scatter, {.paths = 0}), std::invalid_argument);
    EXPECT_THROW(GpuReliefLight(loader, map, scatter, {.detail = 4}), std::invalid_argument);
    EXPECT_THROW(GpuReliefLight(loader, map, scatter, {.albedoMap = Image(3, 3, 3)}), std::invalid_argument);
    EXPECT_THROW(GpuReliefLight(loader, flatMap(5, 4), scatter), std::invalid_argument);
    GpuReliefLight light(loader, map, scatter);
    EXPECT_THROW(light.update({.light = {1, 1, 0}}), std::invalid_argument);
    const GpuEnvironment latlong{EnvMap(EnvLayout::LatLong, 4)};
    EXPECT_THROW(light.update({.surrounding = &latlong}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
