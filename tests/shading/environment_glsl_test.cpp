// Environment lookups in GLSL against core/environment.hpp: positions, directions, seams, poles and corners.
#include <gtest/gtest.h>

#include "core/sampling.hpp"
#include "gpu_evaluate.hpp"
#include "reference/environment_shading.hpp"
#include "shading/gpu_environment.hpp"

namespace nacre {
namespace {

constexpr EnvLayout kAll[] = {EnvLayout::LatLong, EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::Octahedral};
constexpr std::pair<GlApi, Glsl> kDialects[] = {
    {GlApi::Core33, Glsl::V330}, {GlApi::Core45, Glsl::V450}, {GlApi::Es3, Glsl::Es300}};

/// The bar for GLSL against C++ with half floats.
constexpr double kRelative = 2e-3;

/// A surrounding without symmetry, 0.2 to 5, that changes by about 2 % a texel of 64.
Rgb smooth(const Vec3& d) {
    return {std::exp(d.x + 0.5 * std::sin(3 * d.y)), std::exp(d.y - 0.6 * d.z * d.x), std::exp(d.z + 0.3 * d.x)};
}

EnvMap smoothMap(EnvLayout layout, int size, double turn = 0) {
    EnvMap map(layout, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x) {
            const Vec3 d = envTexelDirection(layout, size, x, y);
            map.image.setRgb(x, y,
                             smooth({d.x, std::cos(turn) * d.y - std::sin(turn) * d.z,
                                     std::sin(turn) * d.y + std::cos(turn) * d.z}));
        }
    return map;
}

/// Over the whole sphere, and the hard ones: axes, edges, corners, both seams, their neighbourhood.
std::vector<Vec3> directions(std::size_t count) {
    std::vector<Vec3> out;
    for (std::size_t i = 1; i <= count; ++i) {
        const double z = 1 - 2 * radicalInverse(i, 2), phi = 2 * kPi * radicalInverse(i, 3), r = std::sqrt(1 - z * z);
        out.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
    }
    for (const double e : {0.0, 1e-6, 1e-3, -1e-3, 0.02, -0.02})
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (x != 0 || y != 0 || z != 0)
                        out.push_back(glm::normalize(Vec3(x + e, y - 0.7 * e, z + 0.4 * e)));
    for (int i = 0; i < 64; ++i) {
        const double a = 2 * kPi * i / 64;
        out.push_back({std::cos(a), std::sin(a), 0});                                    // rim of the paraboloids
        out.push_back(glm::normalize(Vec3(1e-7 * std::cos(a), 1, 1e-7 * std::sin(a))));  // pole
        out.push_back(glm::normalize(Vec3(1e-7 * std::cos(a), std::sin(a), -1)));  // edge of the latitude-longitude map
    }
    return out;
}

std::vector<DirectionPair> asPairs(const std::vector<Vec3>& directions) {
    std::vector<DirectionPair> out;
    for (const Vec3& d : directions) out.push_back({Vec3(glm::vec3(d)), {0, 0, 1}});
    return out;
}

std::string lookupCode(EnvLayout layout, double lod) {
    const std::string at = std::to_string(lod);
    if (layout == EnvLayout::Cube)
        return "#include \"nacre/environment.glsl\"\nuniform samplerCube test_env;\n"
               "vec4 evaluate(vec3 d, vec3 unused) { return vec4(nacre_env_cube_chain(test_env, d, " +
               at + "), 1.0); }\n";
    return "#include \"nacre/environment.glsl\"\nuniform sampler2D test_env;\n"
           "vec4 evaluate(vec3 d, vec3 unused) { return vec4(nacre_env_chain(test_env, NACRE_ENV_LAYOUT, d, " +
           at + "), 1.0); }\n";
}

std::vector<glm::vec4> lookups(const GpuEnvironment& gpu, double lod, const std::vector<DirectionPair>& pairs,
                               Glsl dialect = Glsl::V330) {
    ShaderDefines defines = gpu.defines();
    if (gpu.layout() == EnvLayout::Cube) defines.clear();  // the file names its layouts itself
    return test::gpuEvaluate({.code = lookupCode(gpu.layout(), lod),
                              .defines = defines,
                              .bind =
                                  [&](const Program& program) {
                                      program.set("test_env", 2);
                                      gpu.bind(2);
                                  },
                              .dialect = dialect},
                             pairs);
}

void expectNear(const glm::vec4& found, const Rgb& expected, const Vec3& d, double relative, double& worst) {
    for (int c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(found[c] - expected[c]) / expected[c]);
        EXPECT_NEAR(found[c], expected[c], relative * expected[c]) << d.x << " " << d.y << " " << d.z;
    }
}

TEST(EnvironmentGlsl, LookupsAreSampleEnvInEveryLayoutAndDialect) {
    const std::vector<Vec3> where = directions(4000);
    const std::vector<DirectionPair> pairs = asPairs(where);
    for (const auto& [api, dialect] : kDialects) {
        test::context(api);
        for (const EnvLayout layout : kAll)
            for (const int size : {64, 5, 2, 1}) {
                SCOPED_TRACE(toString(layout) + " " + std::to_string(size) + " " + toString(dialect));
                const EnvMap map = smoothMap(layout, size);
                const auto found = lookups(GpuEnvironment(map), 0, pairs, dialect);
                double worst = 0;
                for (std::size_t i = 0; i < pairs.size(); ++i)
                    expectNear(found[i], sampleEnv(map, pairs[i].wi), pairs[i].wi, kRelative, worst);
                RecordProperty(toString(layout) + std::to_string(size), std::to_string(worst));
            }
    }
}

TEST(EnvironmentGlsl, LevelsBlendByLod) {
    test::context();
    const std::vector<DirectionPair> pairs = asPairs(directions(1000));
    for (const EnvLayout layout : kAll) {
        SCOPED_TRACE(toString(layout));
        std::vector<EnvMap> levels;
        for (int level = 0; level < 4; ++level) levels.push_back(smoothMap(layout, 32 >> level, 0.7 * level));
        const GpuEnvironment gpu(levels);
        EXPECT_EQ(gpu.levels(), 4);
        for (const double lod : {0.0, 0.25, 1.0, 2.75, 3.0}) {
            const auto found = lookups(gpu, lod, pairs);
            const auto low = static_cast<std::size_t>(lod);
            double worst = 0;
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                const Rgb a = sampleEnv(levels[low], pairs[i].wi);
                const Rgb b = sampleEnv(levels[std::min<std::size_t>(low + 1, 3)], pairs[i].wi);
                expectNear(found[i], a + (lod - static_cast<double>(low)) * (b - a), pairs[i].wi, kRelative, worst);
            }
        }
    }
}

// Single precision and the driver's atan: a thousandth of a texel of 64.
constexpr double kTexels = 4e-3, kDirection = 2e-4;

TEST(EnvironmentGlsl, PositionsAndDirectionsAreThoseOfCpp) {
    test::context();
    const std::vector<DirectionPair> pairs = asPairs(directions(2000));
    constexpr int kSize = 64;
    for (const EnvLayout layout : kAll) {
        SCOPED_TRACE(toString(layout));
        const std::string kind = std::to_string(static_cast<int>(layout));
        if (layout != EnvLayout::Cube) {
            const auto found =
                test::gpuEvaluate({.code = "#include \"nacre/environment.glsl\"\nvec4 evaluate(vec3 d, vec3 unused) {\n"
                                           "    vec2 p = nacre_env_position(" +
                                           kind +
                                           ", d, 64.0);\n"
                                           "    return vec4(p, dot(d, nacre_env_direction(" +
                                           kind + ", p, 64.0)), 1.0);\n}\n"},
                                  pairs);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                const Vec3& d = pairs[i].wi;
                const glm::dvec2 p = envPosition(layout, kSize, d);
                const bool pole = layout == EnvLayout::LatLong && std::hypot(d.x, d.z) < 1e-5;
                const bool edge = layout == EnvLayout::LatLong && d.z < 0 && std::abs(d.x) < 1e-5;
                const bool bottom = layout == EnvLayout::Octahedral && d.z < -1 + 1e-5;  // any of the four corners
                if (!pole && !edge && !bottom) {
                    EXPECT_NEAR(found[i].x, p.x, kTexels) << d.x << " " << d.y << " " << d.z;
                }
                if (!bottom) {
                    EXPECT_NEAR(found[i].y, p.y, kTexels) << d.x << " " << d.y << " " << d.z;
                }
                EXPECT_GT(found[i].z, 1 - kDirection);  // there and back
            }
        }
        const glm::ivec2 extent = envExtent(layout, kSize);
        std::vector<DirectionPair> places;
        for (std::uint64_t i = 1; i < 2000; ++i)
            places.push_back({{radicalInverse(i, 2) * extent.x, radicalInverse(i, 3) * extent.y, 0}, {0, 0, 1}});
        const auto back =
            test::gpuEvaluate({.code = "#include \"nacre/environment.glsl\"\nvec4 evaluate(vec3 p, vec3 unused) {\n"
                                       "    return vec4(nacre_env_direction(" +
                                       kind + ", p.xy, 64.0), 1.0);\n}\n"},
                              places);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Vec3 d =
                envDirection(layout, kSize, static_cast<float>(places[i].wi.x), static_cast<float>(places[i].wi.y));
            EXPECT_LT(glm::length(Vec3(back[i]) - d), kDirection) << places[i].wi.x << " " << places[i].wi.y;
        }
    }
}

TEST(EnvironmentGlsl, MirroredAndRefractedDirections) {
    test::context();
    std::vector<DirectionPair> pairs = test::testPairs(500);  // wi = to the eye, wo = normal
    for (const double ior : {1.0, 1.5, 200.0, 0.66}) {
        const auto r =
            test::gpuEvaluate({.code = "#include \"nacre/environment.glsl\"\nvec4 evaluate(vec3 v, vec3 n) {\n"
                                       "    return vec4(nacre_env_reflect(v, n), 1.0);\n}\n"},
                              pairs);
        const auto t =
            test::gpuEvaluate({.code = "#include \"nacre/environment.glsl\"\nvec4 evaluate(vec3 v, vec3 n) {\n"
                                       "    return vec4(nacre_env_refract(v, n, " +
                                       std::to_string(ior) + "), 1.0);\n}\n"},
                              pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const Vec3 &v = pairs[i].wi, &n = pairs[i].wo;
            if (glm::dot(v, n) <= 0) continue;
            EXPECT_LT(glm::length(Vec3(r[i]) - mirrored(v, n)), 1e-5);
            const double sine = glm::length(v - glm::dot(v, n) * n) / ior;
            if (std::abs(sine - 1) < 1e-3) continue;  // rounding decides whether all is reflected
            EXPECT_LT(glm::length(Vec3(t[i]) - refracted(v, n, ior)), 1e-4) << ior;
        }
    }
}

AssetTexture table(const std::string& mapping, int width, int height, int channels) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y, c) = static_cast<float>(0.2 + 0.5 * std::sin(0.1 * x + 0.3 * y + c) * std::sin(0.1 * x));
    AssetTexture out = makeTexture("table", mapping, image, TexelFormat::Half);
    out.scale = {1.5f, 1.4f, 1.3f, 1.0f};
    out.bias = {0.1f, 0.2f, 0.3f, 0.0f};
    return out;
}

glm::vec4 lookedUp(const AssetTexture& t, double u, double v) {
    const auto centre = [](double c, int n) { return static_cast<float>((c * (n - 1) + 0.5) / n); };
    return t.bias + t.scale * sampleBilinear(t.image, centre(u, t.image.width()), centre(v, t.image.height()));
}

TEST(EnvironmentGlsl, TablesAreAddressedAsTheirMappingsSay) {
    test::context();
    const std::vector<DirectionPair> pairs = test::testPairs(500);
    for (const int channels : {1, 2, 3}) {
        const AssetTexture t = channels == 2 ? table("cos_perceptual", 32, 16, 2) : table("sqrt_cos", 64, 1, channels);
        const GpuEnvironmentTable gpu(t);
        EXPECT_EQ(gpu.isFresnel(), channels != 2);
        const std::string call = channels == 2 ? "vec4(nacre_env_scale_bias(nacre_env_table, nacre_env_table_scale, "
                                                 "nacre_env_table_bias, v.z, n.z), 0.0, 1.0)"
                                               : "vec4(nacre_env_fresnel(nacre_env_table, nacre_env_table_scale, "
                                                 "nacre_env_table_bias, v.z), 1.0)";
        const auto found = test::gpuEvaluate({.code = "#include \"nacre/bind/environment.glsl\"\n"
                                                      "vec4 evaluate(vec3 v, vec3 n) { return " +
                                                      call + "; }\n",
                                              .bind = [&](const Program& program) { gpu.bind(program, 2); }},
                                             pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const glm::vec4 expected = lookedUp(t, std::sqrt(pairs[i].wi.z), channels == 2 ? pairs[i].wo.z : 0);
            for (int c = 0; c < (channels == 2 ? 2 : 3); ++c)
                EXPECT_NEAR(found[i][c], expected[channels == 1 ? 0 : c], 1e-4) << channels;
        }
    }
    EXPECT_THROW(GpuEnvironmentTable(table("half_diff", 4, 1, 1)), std::invalid_argument);
    EXPECT_THROW(GpuEnvironmentTable(table("sqrt_cos", 4, 1, 2)), std::invalid_argument);
    EXPECT_THROW(GpuEnvironmentTable(table("cos_perceptual", 4, 4, 3)), std::invalid_argument);
}

TEST(EnvironmentGlsl, CombinationsAreTheFormulas) {
    test::context();
    const std::vector<DirectionPair> pairs = test::testPairs(200);
    const auto evaluate = [&](const std::string& expression) {
        return test::gpuEvaluate({.code = "#include \"nacre/environment.glsl\"\nvec4 evaluate(vec3 a, vec3 b) {\n"
                                          "    vec3 f = abs(a);\n    vec3 m = 3.0 * abs(b);\n"
                                          "    vec3 d = abs(b.zxy);\n    return vec4(" +
                                          expression + ", 1.0);\n}\n"},
                                 pairs);
    };
    const auto add = evaluate("nacre_env_add(f, m, d)"), blend = evaluate("nacre_env_blend(f, m, d)");
    const auto single = evaluate("nacre_env_reflectance(f, vec2(0.7, 0.1))");
    const auto multiple = evaluate("nacre_env_multiple_scattering(f, vec2(0.7, 0.1))");
    const auto white = evaluate("nacre_env_multiple_scattering(vec3(1.0), 0.1 + 0.4 * f.xy)");
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double f = std::abs(pairs[i].wi[c]), m = 3 * std::abs(pairs[i].wo[c]);
            const double d = std::abs(pairs[i].wo[(c + 2) % 3]), average = f + (1 - f) / 21, s = 0.7 * f + 0.1;
            EXPECT_NEAR(add[i][c], f * m + d, 1e-5);
            EXPECT_NEAR(blend[i][c], f * m + (1 - f) * d, 1e-5);
            EXPECT_NEAR(single[i][c], s, 1e-5);
            EXPECT_NEAR(multiple[i][c], s + s * average * 0.2 / (1 - 0.2 * average), 1e-5);
            EXPECT_NEAR(white[i][c], 1, 1e-5);
        }
}

TEST(GpuEnvironment, RejectsWhatItCannotHold) {
    test::context();
    EXPECT_THROW(GpuEnvironment(std::vector<EnvMap>{}), std::invalid_argument);
    const EnvMap cube = smoothMap(EnvLayout::Cube, 8), octahedron = smoothMap(EnvLayout::Octahedral, 4);
    EXPECT_THROW(GpuEnvironment(std::vector<EnvMap>{cube, octahedron}), std::invalid_argument);
    EXPECT_THROW(GpuEnvironment(std::vector<EnvMap>{cube, cube}), std::invalid_argument);
    EXPECT_THROW(
        GpuEnvironment(std::vector<EnvMap>{smoothMap(EnvLayout::LatLong, 3), smoothMap(EnvLayout::LatLong, 1)}),
        std::invalid_argument);  // 6 x 3 halves to 3 x 1, a map of size 1 is 2 x 1
    EXPECT_THROW(GpuEnvironment(cube, {.format = TexelFormat::Unorm8}), std::invalid_argument);
    EXPECT_THROW(GpuEnvironment(cube, {.scale = 0}), std::invalid_argument);
    EnvMap bright = cube;
    bright.image.setRgb(3, 5, Rgb(1e6));
    EXPECT_THROW(GpuEnvironment{bright}, StorageError);
    EXPECT_EQ(GpuEnvironment(bright, {.scale = 16}).scale(), 16);
    EXPECT_EQ(GpuEnvironment(bright, {.format = TexelFormat::Float}).bytes(), 6u * 64 * 3 * 4);
    bright.image.setRgb(3, 5, Rgb(std::nan("")));
    EXPECT_THROW(GpuEnvironment(bright, {.format = TexelFormat::Float}), StorageError);
}

}  // namespace
}  // namespace nacre
