// The GPU's prefilter against the baker's, its parts against their C++ twins, and its promises on time.
#include "shading/gpu_prefilter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "envmaps/anisotropic_filter.hpp"
#include "gpu_evaluate.hpp"
#include "reference/environment_error.hpp"

namespace nacre {
namespace {

// Root mean square difference to nacre::prefilter over all texels, as a share of the mean, on `ripples`.
constexpr double kAgainstBaker = 1.2e-3;    // detail 8; measured 8.7e-4
constexpr double kAgainstBakerFine = 3e-4;  // detail 16; measured 1.2e-4
constexpr double kMergedTexels = 5e-4;      // as fine, but the baker's anisotropic sums merge texels; measured 3.7e-4
constexpr double kSpike = 2e-3;             // all light from one texel; measured 5.4e-4
constexpr double kKernel = 2e-5;            // single precision against double, of the lobe's largest value
constexpr double kTangent = 1e-4;           // rounding over the sine of the angle to the axis, here 0.002 or more
constexpr double kWhite = 2e-6;             // rounding of sums of thousands of terms

/// Waves of several lengths, a lamp, and one texel that outshines all.
EnvMap ripples(int size) {
    EnvMap map(EnvLayout::Cube, size);
    for (int y = 0; y < 6 * size; ++y)
        for (int x = 0; x < size; ++x) {
            const Vec3 d = envTexelDirection(EnvLayout::Cube, size, x, y);
            const double lamp = glm::dot(d, glm::normalize(Vec3(0.5, 0.6, 0.3))) > 0.97 ? 20 : 0;
            map.image.setRgb(x, y, Rgb(1 + d.y + lamp, 1 + std::sin(20 * d.x), 0.5 + 0.5 * std::sin(9 * d.z)));
        }
    return map;
}

EnvMap flat(int size, double value) {
    EnvMap map(EnvLayout::Cube, size);
    for (float& v : map.image.data()) v = static_cast<float>(value);
    return map;
}

struct Uploaded {
    explicit Uploaded(const EnvMap& map) { uploadCube(map, texture); }
    TextureName texture;
};

void complete(GpuPrefilter& prefilter, const Uploaded& source) {
    while (!prefilter.update(source.texture.name(), 1000)) {
    }
}

EnvMap gpuFiltered(const EnvMap& map, const PrefilterLevel& level, const GpuPrefilterOptions& options) {
    ProgramLoader loader;
    GpuPrefilter prefilter(loader, map.size(), {level}, options);
    complete(prefilter, Uploaded(map));
    return prefilter.read(0);
}

double difference(const EnvMap& a, const EnvMap& b) {
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < a.image.data().size(); ++i) {
        squares += sqr(a.image.data()[i] - b.image.data()[i]);
        sum += b.image.data()[i];
    }
    const double count = static_cast<double>(a.image.data().size());
    return std::sqrt(squares / count) / (sum / count);
}

const Lobe kLobes[] = {{LobeKind::Diffuse},          {LobeKind::Phong, 1},      {LobeKind::Phong, 30},
                       {LobeKind::Phong, 2000},      {LobeKind::Ggx, 0, 0.018}, {LobeKind::Ggx, 0, 0.0858},
                       {LobeKind::Ggx, 0, 0.25},     {LobeKind::Ggx, 0, 1},     {LobeKind::Beckmann, 0, 0.02},
                       {LobeKind::Beckmann, 0, 0.3}, {LobeKind::Beckmann, 0, 1}};

// Refraction from both sides and far from any material; anisotropy both ways round, mild and strong.
const Lobe kBent[] = {{LobeKind::GgxRefraction, 0, 0.25, 1.5},         {LobeKind::GgxRefraction, 0, 1, 1.5},
                      {LobeKind::GgxRefraction, 0, 0.3, 1 / 1.5},      {LobeKind::GgxRefraction, 0, 1, 0.5},
                      {LobeKind::GgxRefraction, 0, 0.05, 200},         {LobeKind::GgxRefraction, 0, 1, 200},
                      {LobeKind::BeckmannRefraction, 0, 0.3, 1.5},     {LobeKind::BeckmannRefraction, 0, 1, 1.33},
                      {LobeKind::BeckmannRefraction, 0, 0.4, 1 / 2.4}, {LobeKind::BeckmannRefraction, 0, 0.5, 200}};
const Lobe kAnisotropic[] = {{LobeKind::GgxAnisotropic, 0, 0.3, 1, 0.3},
                             {LobeKind::GgxAnisotropic, 0, 0.2, 1, 0.6, Vec3(1, 0, 0)},
                             {LobeKind::GgxAnisotropic, 0, 1, 1, 0.05, Vec3(1, 2, 3)},
                             {LobeKind::GgxAnisotropic, 0, 0.04, 1, 0.4}};
// Lobes narrower than a texel, down to what single precision can't tell from none: the weights of the nearest centres
// decide, or the nearest texel alone.
const Lobe kNarrow[] = {{LobeKind::Ggx, 0, 1e-3},
                        {LobeKind::Beckmann, 0, 1e-3},
                        {LobeKind::GgxRefraction, 0, 1e-3, 1.5},
                        {LobeKind::GgxRefraction, 0, 1e-3, 200},
                        {LobeKind::GgxRefraction, 0, 1e-3, 0.7},
                        {LobeKind::GgxRefraction, 0, 1, 1.001},
                        {LobeKind::GgxRefraction, 0, 1e-3, 1.001},
                        {LobeKind::GgxRefraction, 0, 1e-3, 1 - 1e-7},
                        {LobeKind::GgxRefraction, 0, 1, 1 + 1e-15},
                        {LobeKind::BeckmannRefraction, 0, 1e-3, 1.5},
                        {LobeKind::BeckmannRefraction, 0, 1, 1.001},
                        {LobeKind::BeckmannRefraction, 0, 1e-3, 1 + 1e-7},
                        {LobeKind::GgxAnisotropic, 0, 1e-3, 1, 1e-3},
                        {LobeKind::GgxAnisotropic, 0, 1e-3, 1, 0.3},
                        {LobeKind::GgxAnisotropic, 0, 1, 1, 1e-3}};

std::string words(const Lobe& lobe) {
    return toString(lobe.kind) + " " + std::to_string(lobe.kind == LobeKind::Phong ? lobe.exponent : lobe.alpha) +
           (lobe.ior != 1 ? " ior " + std::to_string(lobe.ior) : "") +
           (lobe.alphaY != 0 ? " alphaY " + std::to_string(lobe.alphaY) : "");
}

EnvMap baked(const EnvMap& map, const PrefilterLevel& level) {
    PrefilterOptions options;
    options.tolerance = 1e-5;
    return prefilter(map, {&level, 1}, options).levels[0];
}

TEST(GpuPrefilter, AgreesWithTheBaker) {
    test::context();
    const EnvMap map = ripples(64);
    for (const auto& lobes :
         {std::span<const Lobe>(kLobes), std::span<const Lobe>(kBent), std::span<const Lobe>(kAnisotropic)})
        for (const Lobe& lobe : lobes) {
            const PrefilterLevel level{lobe, 8};
            const EnvMap expected = baked(map, level);
            const EnvMap usual = gpuFiltered(map, level, {.color = ColorFormat::Rgba32F});
            const EnvMap fine = gpuFiltered(map, level, {.detail = 16, .color = ColorFormat::Rgba32F});
            EXPECT_LT(difference(usual, expected), kAgainstBaker) << words(lobe);
            if (isZonal(lobe.kind)) {
                EXPECT_LT(difference(fine, expected), kAgainstBakerFine) << words(lobe);
            } else {
                EXPECT_LT(difference(fine, expected), kMergedTexels) << words(lobe);
                EXPECT_LT(measureEnvironment(fine, EnvironmentTruth(map), lobe, 100).rmse, kAgainstBakerFine);
            }
        }
}

// 16 from 72: no texel of the result is as far from one centre as from another, which rounding would decide between.
TEST(GpuPrefilter, AgreesWithTheBakerWhereLobesAreNarrow) {
    test::context();
    const EnvMap map = ripples(72);
    for (const Lobe& lobe : kNarrow) {
        const EnvMap found = gpuFiltered(map, {lobe, 16}, {.color = ColorFormat::Rgba32F});
        EXPECT_LT(difference(found, baked(map, {lobe, 16})), kAgainstBaker) << words(lobe);
    }
}

// llvmpipe ends all loops of a draw after 65535 steps together, without a word: longer sums are drawn in parts.
TEST(GpuPrefilter, LongSumsAreDrawnInParts) {
    for (const bool es : {false, true}) {
        test::context(es ? GlApi::Es3 : GlApi::Core33);
        ProgramLoader loader(es ? Glsl::Es300 : Glsl::V330);
        const auto found = [&](const EnvMap& map, const PrefilterLevel& level, double detail) {
            GpuPrefilter prefilter(loader, map.size(), {level}, {.detail = detail, .color = ColorFormat::Rgba32F});
            complete(prefilter, Uploaded(map));
            return prefilter.read(0);
        };
        const EnvMap map = ripples(es ? 128 : 256);
        const PrefilterLevel brushed{{LobeKind::GgxAnisotropic, 0, 0.02, 1, 0.3}, 4},
            round{{LobeKind::Ggx, 0, 0.25}, 4};
        EXPECT_LT(difference(found(map, brushed, es ? 16 : 8), baked(map, brushed)), kAgainstBaker);
        EXPECT_LT(difference(found(map, round, 64), baked(map, round)), kAgainstBakerFine);
    }
}

TEST(GpuPrefilter, AnIndexOfOneIsAMirror) {
    test::context();
    const EnvMap map = ripples(32);
    for (const LobeKind kind : {LobeKind::GgxRefraction, LobeKind::BeckmannRefraction})
        for (const int size : {32, 8}) {
            const PrefilterLevel bent{{kind, 0, 0.5, 1}, size}, mirror{{}, size};
            EXPECT_EQ(gpuFiltered(map, bent, {}).image.data(), gpuFiltered(map, mirror, {}).image.data());
        }
}

// Odd faces have a texel whose centre is the lobe's axis, where the tangent is a convention.
TEST(GpuPrefilter, AnisotropicLobesHaveATangentAtTheirAxis) {
    test::context();
    const PrefilterLevel level{{LobeKind::GgxAnisotropic, 0, 0.5, 1, 0.1}, 7};
    const EnvMap map = ripples(32);
    EXPECT_LT(difference(gpuFiltered(map, level, {.color = ColorFormat::Rgba32F}), baked(map, level)), kAgainstBaker);
}

TEST(GpuPrefilter, RunsOnEs3) {
    test::context(GlApi::Es3);
    const EnvMap map = ripples(32);
    const PrefilterLevel level{{LobeKind::Beckmann, 0, 0.3}, 8};
    ProgramLoader loader(Glsl::Es300);
    GpuPrefilter prefilter(loader, 32, {level}, {.color = ColorFormat::Rgba32F});
    complete(prefilter, Uploaded(map));
    EXPECT_LT(measureEnvironment(prefilter.read(0), EnvironmentTruth(map), level.lobe, 300).rmse, kAgainstBaker);
}

TEST(GpuPrefilter, WhiteStaysWhite) {
    test::context();
    for (const int size : {1, 2, 7, 24, 64})
        for (const auto& lobes : {std::span<const Lobe>(kLobes), std::span<const Lobe>(kBent),
                                  std::span<const Lobe>(kAnisotropic), std::span<const Lobe>(kNarrow)})
            for (const Lobe& lobe : lobes) {
                const EnvMap out = gpuFiltered(flat(size, 1), {lobe, 4}, {.color = ColorFormat::Rgba32F});
                for (const float v : out.image.data()) ASSERT_NEAR(v, 1, kWhite) << words(lobe) << ", source " << size;
            }
}

TEST(GpuPrefilter, MirrorsAndChainsKeepTheirPlaces) {
    test::context();
    const EnvMap map = ripples(32);
    ProgramLoader loader;
    GpuPrefilter prefilter(loader, 32, {{{}, 32}, {{LobeKind::Phong, 200}, 16}, {{LobeKind::Diffuse}, 8}},
                           {.color = ColorFormat::Rgba32F});
    EXPECT_FALSE(prefilter.ready());
    complete(prefilter, Uploaded(map));
    EXPECT_TRUE(prefilter.ready());
    const EnvMap mirror = prefilter.read(0);
    for (std::size_t i = 0; i < map.image.data().size(); ++i)
        ASSERT_NEAR(mirror.image.data()[i], map.image.data()[i], 1e-4 * 20) << i;
    const EnvironmentTruth truth(map);
    EXPECT_LT(measureEnvironment(prefilter.read(1), truth, {LobeKind::Phong, 200}, 100).rmse, kAgainstBaker);
    EXPECT_LT(measureEnvironment(prefilter.read(2), truth, {LobeKind::Diffuse}, 100).rmse, kAgainstBaker);
    EXPECT_THROW(prefilter.read(3), std::invalid_argument);
}

// Shown is the last complete chain, made of the source as it was when the chain began, by any number of steps.
TEST(GpuPrefilter, UpdatesProgressivelyAndShowsCompleteChains) {
    test::context();
    const std::vector<PrefilterLevel> levels{{{LobeKind::Phong, 50}, 20}, {{LobeKind::Ggx, 0, 0.3}, 10}};
    const Uploaded first(ripples(32)), second(flat(32, 5));
    ProgramLoader loader;
    GpuPrefilter whole(loader, 32, levels), steps(loader, 32, levels);
    complete(whole, first);
    int calls = 1;
    double progress = 0;
    ASSERT_FALSE(steps.update(first.texture.name(), 0));
    while (!steps.update(second.texture.name(), 0)) {  // too late to matter
        EXPECT_FALSE(steps.ready());
        EXPECT_GT(steps.progress(), progress);
        progress = steps.progress();
        ++calls;
    }
    EXPECT_EQ(calls + 1, 6 * (9 + 4));  // one tile a call
    for (int level : {0, 1}) EXPECT_EQ(steps.read(level).image.data(), whole.read(level).image.data());
    const GlName shown = steps.result();
    EXPECT_FALSE(steps.update(second.texture.name(), 0));
    EXPECT_EQ(steps.result(), shown);
    EXPECT_EQ(steps.read(0).image.data(), whole.read(0).image.data());
    complete(steps, first);
    EXPECT_NE(steps.result(), shown);
    EXPECT_NEAR(steps.read(1).image.data()[7], 5, 0.005);  // half floats
}

TEST(GpuPrefilter, BlackAndOneBrightTexel) {
    test::context();
    EnvMap spike = flat(32, 0);
    EXPECT_EQ(gpuFiltered(spike, {{LobeKind::Ggx, 0, 0.2}, 8}, {}).image.data(), flat(8, 0).image.data());
    spike.image.setRgb(31, 31, Rgb(1e5));  // in a corner of +X
    const PrefilterLevel level{{LobeKind::Ggx, 0, 0.2}, 16};
    const EnvMap found = gpuFiltered(spike, level, {.color = ColorFormat::Rgba32F});
    EXPECT_LT(measureEnvironment(found, EnvironmentTruth(spike), level.lobe, 300).rmse, kSpike);
}

TEST(GpuPrefilter, RejectsWhatItCannotDo) {
    test::context();
    ProgramLoader loader;
    const auto make = [&](int source, std::vector<PrefilterLevel> levels, GpuPrefilterOptions options = {}) {
        GpuPrefilter prefilter(loader, source, std::move(levels), options);
    };
    EXPECT_THROW(make(0, {{{LobeKind::Diffuse}, 4}}), std::invalid_argument);
    EXPECT_THROW(make(8, {}), std::invalid_argument);
    EXPECT_THROW(make(8, {{{LobeKind::GgxRefraction, 0, 0.3, 0}, 4}}), std::invalid_argument);
    EXPECT_THROW(make(8, {{{LobeKind::GgxRefraction, 0, 0.3, 1}, 3}}), std::invalid_argument);
    EXPECT_THROW(make(8, {{{LobeKind::GgxAnisotropic, 0, 0.3, 1, 0}, 4}}), std::invalid_argument);
    EXPECT_THROW(make(8, {{{LobeKind::Diffuse}, 4}, {{LobeKind::Diffuse}, 4}}), std::invalid_argument);
    EXPECT_THROW(make(8, {{{}, 16}}), std::invalid_argument);
    EXPECT_THROW(make(8, {{{LobeKind::Diffuse}, 4}}, {.detail = 0.5}), std::invalid_argument);
    EXPECT_THROW(uploadCube(EnvMap(EnvLayout::LatLong, 4), TextureName()), std::invalid_argument);
}

// Twins: zonalKernel at |wi - wo|, envSolidAngle, envTexelDirection and envPosition.
TEST(PrefilterGlsl, LobesAreTheTwins) {
    test::context();
    std::vector<DirectionPair> pairs;
    for (int i = 0; i <= 1000; ++i) {
        const double theta = kPi / 2 * sqr(i / 1000.0) * 1.05;
        pairs.push_back({Vec3(0, 0, 1), Vec3(std::sin(theta), 0, std::cos(theta))});
    }
    for (const Lobe& lobe : kLobes) {
        const std::string call =
            lobe.kind == LobeKind::Diffuse ? "nacre_prefilter_cosine(dot(g, g))"
            : lobe.kind == LobeKind::Phong
                ? "nacre_prefilter_phong(dot(g, g), " + std::to_string(lobe.exponent) + ")"
                : "nacre_prefilter_" + toString(lobe.kind) + "(dot(g, g), " + std::to_string(lobe.alpha) + ")";
        const auto found = test::gpuEvaluate({"#include \"nacre/prefilter.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                                              "    vec3 g = wi - wo;\n    return vec4(" +
                                              call + ");\n}\n"},
                                             pairs);
        const ZonalKernel kernel = zonalKernel(lobe);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            ASSERT_NEAR(found[i].x, kernel.value(std::acos(std::min(1.0, pairs[i].wo.z))), kKernel)
                << words(lobe) << " at " << pairs[i].wo.x;
    }
}

TEST(PrefilterGlsl, RefractionsAreTheTwins) {
    test::context();
    for (const LobeKind kind : {LobeKind::GgxRefraction, LobeKind::BeckmannRefraction}) {
        std::vector<DirectionPair> pairs;  // wi: theta, alpha and 1 - 1/ior
        std::vector<double> expected;
        for (const double alpha : {1e-3, 0.05, 0.3, 1.0})
            for (const double ior : {0.01, 0.5, 0.9, 0.9999, 1.0001, 1.1, 1.5, 200.0}) {
                const ZonalKernel kernel = zonalKernel({kind, 0, alpha, ior});
                for (int i = 0; i < 2000; ++i) {  // evenly over the lobe's middle, then over all of it
                    const double reach = i % 2 ? 1.01 * kernel.support : std::min(4 * kernel.width, kernel.support);
                    const float theta = static_cast<float>(reach * i / 2000);
                    pairs.push_back({Vec3(theta, alpha, (ior - 1) / ior), Vec3(0)});
                    expected.push_back(kernel.value(theta));
                }
            }
        const auto found = test::gpuEvaluate({"#include \"nacre/prefilter.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                                              "    float sine = sin(0.5 * wi.x);\n    return vec4(nacre_prefilter_" +
                                              toString(kind) + "(4.0 * sine * sine, wi.y, wi.z));\n}\n"},
                                             pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            ASSERT_NEAR(found[i].x, expected[i], kKernel) << toString(kind) << " theta " << pairs[i].wi.x << " alpha "
                                                          << pairs[i].wi.y << " bend " << pairs[i].wi.z;
    }
}

// Twins: the weight of filterAnisotropic, here by the reference's half vectors, and lobeTangent.
TEST(PrefilterGlsl, AnisotropicLobesAreTheTwins) {
    test::context();
    const std::vector<DirectionPair> pairs = test::testPairs(2000);  // wi: l, wo: r
    for (const Lobe& lobe : kAnisotropic) {
        const Vec3 axis = glm::normalize(lobe.axis);
        const auto found = test::gpuEvaluate(
            {"#include \"nacre/prefilter.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n    vec3 gap = wi - wo;\n" +
             fmt::format("    vec3 t = nacre_prefilter_tangent(vec3({:.9f}, {:.9f}, {:.9f}), wo);\n"
                         "    vec2 slope = vec2(dot(gap, t) / {:.9f}, dot(gap, cross(wo, t)) / {:.9f});\n",
                         axis.x, axis.y, axis.z, lobe.alpha, lobe.alphaY) +
             "    return vec4(t, nacre_prefilter_ggx_anisotropic(dot(gap, gap), dot(slope, slope)));\n}\n"},
            pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const Vec3 r = pairs[i].wo;
            const double scale = 1 / lobeWeight(lobe, r, r);
            ASSERT_NEAR(found[i].w, scale * lobeWeight(lobe, r, pairs[i].wi), kKernel) << words(lobe) << ", pair " << i;
            ASSERT_LT(glm::distance(Vec3(found[i]), lobeTangent(lobe.axis, r)), kTangent) << words(lobe) << ", " << i;
        }
    }
}

TEST(PrefilterGlsl, PlacesSurvivePacking) {
    test::context();
    std::vector<DirectionPair> pairs{{Vec3(0.5, 0.5, 0), Vec3(0)}, {Vec3(0, 1, 0), Vec3(0)}, {Vec3(1, 0, 0), Vec3(0)}};
    for (int i = 0; i < 100; ++i) pairs.push_back({Vec3(i / 99.0, 1 - sqr(i / 99.0), 0), Vec3(0)});
    const auto found = test::gpuEvaluate({"#include \"nacre/prefilter.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                                          "    float one = nacre_prefilter_pack(wi.xy);\n"
                                          "    return vec4(nacre_prefilter_unpack(one), 0.0, 0.0);\n}\n"},
                                         pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (int c = 0; c < 2; ++c) ASSERT_NEAR(found[i][c], pairs[i].wi[c], i < 3 ? 1e-7 : 0.51 / 4094) << i;
}

TEST(PrefilterGlsl, StripIsTheCubeLayout) {
    test::context();
    for (const int size : {8, 33}) {
        std::vector<DirectionPair> pairs;  // a texel in, its direction and solid angle out
        for (int y = 0; y < 6 * size; ++y)
            for (int x = 0; x < size; ++x) pairs.push_back({Vec3(x, y, size), Vec3(0)});
        const auto found = test::gpuEvaluate({"#include \"nacre/prefilter.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                                              "    ivec2 texel = ivec2(wi.xy + 0.5);\n    int edge = int(wi.z + 0.5);\n"
                                              "    vec3 d = nacre_prefilter_direction(texel, edge);\n"
                                              "    if (nacre_prefilter_texel(d, edge) != texel) return vec4(0.0);\n"
                                              "    float h = 2.0 / float(edge);\n"
                                              "    vec2 st = (vec2(texel.x, texel.y % edge) + 0.5) * h - 1.0;\n"
                                              "    return vec4(d, nacre_prefilter_solid_angle(st, h));\n}\n"},
                                             pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const int x = static_cast<int>(pairs[i].wi.x), y = static_cast<int>(pairs[i].wi.y);
            const Vec3 d = envTexelDirection(EnvLayout::Cube, size, x, y);
            ASSERT_LT(glm::distance(Vec3(found[i]), d), 1e-6) << x << ", " << y;
            const double angle = envSolidAngle(EnvLayout::Cube, size, x, y);
            ASSERT_NEAR(found[i].w / angle, 1, size == 8 ? 3e-4 : 2e-6) << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace nacre
