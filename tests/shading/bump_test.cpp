// Reliefs: GLSL against the lookups in C++, and pictures whose content is known.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "bump/bump_levels.hpp"
#include "bump/bump_lookup.hpp"
#include "core/directions.hpp"
#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "shading/environment_pass.hpp"
#include "shading/lit_pass.hpp"
#include "shading/pass_state.hpp"
#include "shading/primitives.hpp"
#include "shading/shading_frame.hpp"

namespace nacre {
namespace {

constexpr int kPixels = 128;
// Half textures are given to both sides; what is left is single precision and the sampler's weights.
constexpr double kSingle = 1e-4, kSampler = 2e-3;

constexpr BumpShadow kShadows[] = {BumpShadow::HardEllipse, BumpShadow::Ellipse, BumpShadow::HardHorizon,
                                   BumpShadow::Horizon};

/// Not symmetric in any way.
HeightMap hills(int width, int height, Wrap wrap) {
    HeightMap map{Image(width, height, 1), wrap};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            map.heights.at(x, y, 0) =
                static_cast<float>(2 * std::sin(2 * kPi * x / width + std::cos(4 * kPi * y / height)) +
                                   (x > width / 3 && y > height / 2 ? 1.5 : 0));
    return map;
}

/// As the asset's half floats are.
BumpMaps bake(const HeightMap& map, int azimuths = 6) {
    BumpMaps out;
    out.width = map.width();
    out.height = map.height();
    out.wrap = map.wrap;
    out.normals = makeNormals(map);
    out.horizons = makeHorizonMap(map, azimuths);
    out.ellipses = fitEllipses(map, {.directions = 32});
    return bumpFromAsset(toAsset(out), "test");
}

BumpMaps flat(int size = 8) { return bake({Image(size, size, 1), Wrap::Repeat}); }

Camera facing() {
    Camera camera;
    camera.eye = {0, 0, 3};
    camera.orthographic = true;
    camera.height = 2;
    return camera;
}

/// Renders a quad that fills the picture and gives `expression` of NacreBump `p` and light `l` at every pixel.
class Probe {
public:
    Image operator()(const BumpSurface& surface, const std::string& expression, const Vec3& light = {0, 0, 1}) const {
        const std::string code =
            "#include \"nacre/bind/bump.glsl\"\n#include \"nacre/bind/view.glsl\"\n"
            "in vec3 v_position;\nin vec3 v_normal;\nin vec4 v_tangent;\nin vec2 v_uv;\nout vec4 color;\nvoid main() "
            "{\n"
            "    NacreBump p = nacre_bump_point(nacre_frame(v_normal, v_tangent), v_tangent.w, v_uv, vec3(0.0, 0.0, "
            "1.0));\n"
            "    vec3 l = nacre_eye.xyz;\n    color = vec4(" +
            expression + ");\n}\n";
        const Program program = ProgramLoader().compile("lit.vert.glsl", {"probe", code}, bumpDefines(surface));
        const RenderTarget target({.width = kPixels, .height = kPixels});
        target.clear();
        bindBump(program, surface, 0);
        program.set("nacre_world_to_clip", glm::mat4(facing().projection(1) * facing().view()));
        program.set("nacre_eye", glm::vec4(glm::vec3(light), 0));
        setModel(program, glm::dmat4(1));
        GpuMesh(makeQuad()).draw();
        return target.read(4);
    }
};

Vec2 uvOf(int x, int y, const Vec2& tiles) {  // the quad's v runs up, rows run down
    return tiles * Vec2((x + 0.5) / kPixels, (kPixels - y - 0.5) / kPixels);
}

const std::vector<Vec3>& someLights() {
    static const std::vector<Vec3> lights = {glm::normalize(Vec3(1, 0.2, 0.3)),
                                             glm::normalize(Vec3(-0.4, 1, 0.5)),
                                             glm::normalize(Vec3(-1, -0.7, 0.1)),
                                             {0, 0, 1},
                                             {0, -1, 0}};
    return lights;
}

double luminanceAt(const Image& picture, int x, int y) { return picture.at(x, y, 1); }

class Bump : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }

    Image draw(const Mesh& mesh, const Camera& camera, const Light& light, const BumpSurface& relief,
               const char* model = "lambert:kd=1") {
        return draw(mesh, LitView{camera, {light}}, relief, model);
    }
    Image draw(const Mesh& mesh, const LitView& view, const BumpSurface& relief, const char* model = "lambert:kd=1") {
        const RenderTarget target({.width = kPixels, .height = kPixels});
        target.clear();
        renderDirect(loader_, target, GpuMesh(mesh), view, directBrdf(makeModel(model)).value(), relief);
        return target.read();
    }
    ProgramLoader loader_;
};

void expectNear(const Image& a, const Image& b, double tolerance) {
    double worst = 0;
    for (std::size_t i = 0; i < a.data().size(); ++i)
        worst = std::max(worst, static_cast<double>(std::abs(a.data()[i] - b.data()[i])));
    EXPECT_LE(worst, tolerance);
}

TEST_F(Bump, PureFunctionsInGlslAndCpp) {
    const auto pairs = test::testPairs(500);
    const auto values = test::gpuEvaluate(
        {.code = "#include \"nacre/bump.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                 "    float value = nacre_ellipse_value(vec3(2.0, 0.5, 3.0) * wo, wo.yx, wi);\n"
                 "    return vec4(value, nacre_lit_share(value, wo.y), nacre_bump_alpha(wi.z, wo.z),\n"
                 "                nacre_horizon_margin(wo.z, wi));\n}\n"},
        pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vec3 l = pairs[i].wi, w = pairs[i].wo;
        const double value = ellipseValue({2 * w.x, 0.5 * w.y, 3 * w.z, w.y, w.x}, l);
        EXPECT_NEAR(values[i].x, value, kSingle);
        if (std::abs(value) > kSingle && std::abs(w.y) > 1e-3) {
            EXPECT_NEAR(values[i].y, litShare(value, w.y), kSingle / std::abs(w.y)) << i;
        }
        EXPECT_NEAR(values[i].z, bumpedAlpha(l.z, w.z), kSingle);
        EXPECT_NEAR(values[i].w, std::atan2(l.z, std::hypot(l.x, l.y)) - w.z, kSingle);
    }
}

TEST_F(Bump, FrameInGlslAndCpp) {
    const auto pairs = test::testPairs(500);  // wi: the relief's normal; wo: to the eye
    const Mat3 mesh = shadingFrame({1, 2, 3}, {0.5, 0.1, 0.2, -1});
    for (int column = 0; column < 3; ++column) {
        const auto values =
            test::gpuEvaluate({.code = "#include \"nacre/bump.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                                       "    mat3 mesh = nacre_frame(vec3(1.0, 2.0, 3.0), vec4(0.5, 0.1, 0.2, -1.0));\n"
                                       "    return vec4(nacre_bump_frame(mesh, -1.0, wi, wo)[COLUMN], 0.0);\n}\n",
                               .defines = {{"COLUMN", std::to_string(column)}}},
                              pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const Mat3 frame = bumpedFrame(mesh, -1, pairs[i].wi, pairs[i].wo);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(values[i][c], frame[column][c], 10 * kSingle) << i;
            EXPECT_NEAR(glm::dot(frame[1], glm::cross(frame[2], frame[0])), -1, 1e-9);
            if (const double seen = glm::dot(mesh[2], pairs[i].wo); seen > 0) {
                EXPECT_GE(glm::dot(frame[2], pairs[i].wo), 0.998 * std::min(seen, 0.05)) << "faces away";
            }
        }
    }
}

// Normals, ellipse values and horizon margins at every pixel of tiles of each wrap; mirrored ones are turned over.
TEST_F(Bump, LookupsAreThoseOfCpp) {
    const Probe probe;
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        SCOPED_TRACE(toString(wrap));
        const BumpMaps maps = bake(hills(24, 19, wrap));
        BumpMaps noEllipses = maps;
        noEllipses.ellipses.reset();
        const GpuBump map(maps);
        const Vec2 tiles(2, 1.5);
        const std::string l = wrap == Wrap::Mirror ? "(l * vec3(nacre_bump_mirror(p.uv), 1.0))" : "l";
        const BumpSurface surface{.map = &map, .shadow = BumpShadow::HardEllipse, .tiles = tiles};
        const Image normals = probe(surface, "p.frame[2], 1.0");
        for (int y = 0; y < kPixels; y += 3)
            for (int x = 0; x < kPixels; x += 3) {
                const Vec2 uv = uvOf(x, y, tiles);
                EXPECT_LT(glm::length(normals.rgb(x, y) - normalAt(maps, uv.x, uv.y)), kSampler);
            }
        for (const Vec3& light : someLights()) {
            const Image value = probe(surface, "nacre_ellipse_value(p.shape.xyz, p.offset, " + l + ")", light);
            BumpSurface horizon = surface;
            horizon.shadow = BumpShadow::HardHorizon;
            const Image margin = probe(horizon,
                                       "nacre_horizon_margin(nacre_horizon_elevation(nacre_bump_horizons, "
                                       "nacre_bump_azimuths, p.uv, " +
                                           l + "), l)",
                                       light);
            const Image lit = probe(surface, "nacre_bump_lit(p, l)", light);
            for (int y = 0; y < kPixels; y += 3)
                for (int x = 0; x < kPixels; x += 3) {
                    const Vec2 uv = uvOf(x, y, tiles);
                    const double truth = litMargin(maps, uv.x, uv.y, light);
                    const double tolerance = kSampler * (1 + std::abs(truth));
                    EXPECT_NEAR(value.at(x, y, 0), truth, tolerance);
                    EXPECT_NEAR(margin.at(x, y, 0), litMargin(noEllipses, uv.x, uv.y, light), kSampler);
                    if (std::abs(truth) > tolerance) {
                        EXPECT_EQ(lit.at(x, y, 0), truth > 0 && light.z > 0 ? 1 : 0) << x << " " << y;
                    }
                }
        }
    }
}

// A quad of 8 tiles of 64 texels has 512 texels over 128 pixels: level 2 of each texture, which is looked up itself.
TEST_F(Bump, FarViewsReadTheLevels) {
    BumpMaps maps = bake(hills(64, 64, Wrap::Repeat));
    const GpuBump map(maps);
    const BumpSurface surface{.map = &map, .shadow = BumpShadow::HardEllipse, .tiles = Vec2(8)};
    const Image shape = Probe()(surface, "p.shape"), offset = Probe()(surface, "p.offset, p.visibility, 0.0");
    const EllipseLevel level = ellipseLevels(*maps.ellipses)[2];
    for (int y = 0; y < kPixels; y += 5)
        for (int x = 0; x < kPixels; x += 5) {
            const Vec2 uv = uvOf(x, y, Vec2(8));
            const auto s = sampleWrapped(level.shape, uv.x, uv.y, Wrap::Repeat),
                       o = sampleWrapped(level.offset, uv.x, uv.y, Wrap::Repeat);
            for (int c = 0; c < 4; ++c) EXPECT_NEAR(shape.at(x, y, c), s[static_cast<std::size_t>(c)], kSampler * 4);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(offset.at(x, y, c), o[static_cast<std::size_t>(c)], kSampler * 4);
        }
}

// A soft edge is one pixel wide, sits where the hard one does, and doesn't touch what is all lit or all dark.
TEST_F(Bump, SoftEdgeLimits) {
    const BumpMaps maps = flat();
    const GpuBump map(maps);
    const BumpSurface surface{.map = &map, .shadow = BumpShadow::Ellipse};
    const std::string ramp = "((v_uv.x - 0.5) * 40.0 - 0.13)";
    const Image soft = Probe()(surface, "nacre_lit_share_soft(" + ramp + ", 0.0)");
    const Image wide = Probe()(surface, "nacre_lit_share_soft(" + ramp + ", 5.0)");
    for (int x = 0; x < kPixels; ++x) {
        const double value = ((x + 0.5) / kPixels - 0.5) * 40 - 0.13;
        EXPECT_NEAR(soft.at(x, 7, 0), litShare(value, 0.5 * 40 / kPixels), 1e-3) << x;
        EXPECT_NEAR(wide.at(x, 7, 0), litShare(value, 5), 1e-3) << x;
    }
    for (const char* value : {"0.0", "1.0", "-1e-3", "-3.0"}) {
        const Image share = Probe()(surface, std::string("nacre_lit_share_soft(") + value + ", 0.0)");
        for (int x = 0; x < kPixels; ++x) EXPECT_EQ(share.at(x, 3, 0), std::stod(value) >= 0 ? 1 : 0) << value;
    }
}

// No bump is no bump, with each shadow, BRDF and light, to the rounding of one more normalisation.
TEST_F(Bump, FlatMapsChangeNothing) {
    constexpr double kRounding = 2e-5;
    const GpuBump map(flat());
    const Mesh torus = makeTorus(1, 0.4f, 48, 32);
    Camera camera;
    camera.eye = {1.5, 2.0, 2.5};
    const LitView view{
        camera,
        {{true, glm::normalize(Vec3(1, 2, 1)), {1.0, 0.5, 0.25}}, {false, {-0.5, 1.5, 1.0}, {0.5, 1.0, 2.0}}},
        Rgb(0.1)};
    const GpuMesh mesh(torus);
    const RenderTarget target({.width = kPixels, .height = kPixels});
    const auto picture = [&](const std::function<void()>& render) {
        target.clear();
        render();
        return target.read();
    };
    const GpuDirectBrdf direct = directBrdf(makeModel("ggx:alphax=0.2,alphay=0.4,f=conductor")).value();
    FactorizeOptions options;
    options.method = "cosine";
    const GpuFactoredBrdf factored(factorize(makeModel("torrance-sparrow:alpha=0.4,kd=0.2"), options));
    EnvMap constant(EnvLayout::Cube, 4);
    for (float& v : constant.image.data()) v = 0.5f;
    const GpuEnvironment environment(constant);
    EnvironmentSurface surface;
    surface.reflection = {&environment, 0, Rgb(0.2)};
    surface.diffuse = {&environment, 0, Rgb(0.6)};
    for (const BumpShadow shadow : {BumpShadow::None, BumpShadow::HardEllipse, BumpShadow::Ellipse,
                                    BumpShadow::HardHorizon, BumpShadow::Horizon}) {
        const BumpSurface relief{.map = &map, .shadow = shadow, .tiles = Vec2(5, 3)};
        // soft horizons have an edge at the terminator itself
        const double tolerance = shadow == BumpShadow::Horizon ? 3e-2 : kRounding;
        const auto same = [&](const auto& smooth, const auto& bumped) {
            const Image truth = picture(smooth);
            expectNear(picture(bumped), truth, tolerance * *std::max_element(truth.data().begin(), truth.data().end()));
            EXPECT_GT(luminanceAt(truth, kPixels / 2, kPixels * 3 / 4), 0.1);
        };
        same([&] { renderDirect(loader_, target, mesh, view, direct); },
             [&] { renderDirect(loader_, target, mesh, view, direct, relief); });
        same([&] { renderFactored(loader_, target, mesh, view, factored); },
             [&] { renderFactored(loader_, target, mesh, view, factored, relief); });
        same([&] { renderDirect(loader_, target, mesh, view, direct, surface); },
             [&] { renderDirect(loader_, target, mesh, view, direct, surface, relief); });
        same([&] { renderFactored(loader_, target, mesh, view, factored, surface); },
             [&] { renderFactored(loader_, target, mesh, view, factored, surface, relief); });
        same([&] { renderEnvironment(loader_, target, mesh, camera, surface); },
             [&] { renderEnvironment(loader_, target, mesh, camera, surface, relief); });
    }
}

// Low ground in the first half, high in the second, repeated: walls stand in the middle and at the border. The light is
// at 45 degrees; the shadow is as long as the wall is high.
TEST_F(Bump, AStepsShadowFallsAwayFromTheLight) {
    constexpr int kTexels = 32, kWall = 6;
    const int texel = kPixels / kTexels, middle = kPixels / 2;
    for (const bool alongV : {false, true}) {
        HeightMap step{Image(kTexels, kTexels, 1), Wrap::Repeat};
        for (int y = 0; y < kTexels; ++y)
            for (int x = 0; x < kTexels; ++x) step.heights.at(x, y, 0) = (alongV ? y : x) >= kTexels / 2 ? kWall : 0;
        const GpuBump map(bake(step, 16));
        for (const BumpShadow shadow : kShadows)
            for (const double side : {1.0, -1.0}) {
                SCOPED_TRACE(testing::Message()
                             << (alongV ? "v " : "u ") << side << " shadow " << static_cast<int>(shadow));
                const Vec3 light = glm::normalize(alongV ? Vec3(0, side, 1) : Vec3(side, 0, 1));
                const Image picture =
                    draw(makeQuad(), facing(), {true, light, Rgb(1)}, {.map = &map, .shadow = shadow});
                // luminance at a coordinate along the axis, in texels from the row or column of uv = 0
                const auto at = [&](double c) {
                    const int i = static_cast<int>(c * texel);
                    return alongV ? luminanceAt(picture, middle, kPixels - 1 - i) : luminanceAt(picture, i, middle);
                };
                const double open = std::sqrt(0.5) / kPi;
                const double nearMiddle = kTexels / 2 - 3, nearBorder = 3;
                EXPECT_NEAR(at(side > 0 ? nearMiddle : nearBorder), 0, 1e-6)
                    << "at the wall's foot, away from the light";
                EXPECT_NEAR(at(side > 0 ? nearBorder : nearMiddle), open, 1e-3) << "at the lit wall's foot";
                EXPECT_NEAR(at(kTexels * 0.75), open, 1e-3) << "on the plateau";
                const double before = side > 0 ? kTexels / 2 - kWall + 1.5 : kWall - 1.5;
                const double beyond = side > 0 ? kTexels / 2 - kWall - 3 : kWall + 3;
                EXPECT_NEAR(at(before), 0, 1e-6) << "within the shadow";
                EXPECT_NEAR(at(beyond), open, 1e-3) << "beyond the shadow";
            }
    }
}

// A mirrored second tile is the first one in a mirror, light and all.
TEST_F(Bump, MirroredTilesAreLitAsMirrored) {
    const GpuBump map(bake(hills(32, 32, Wrap::Mirror)));
    for (const BumpShadow shadow : kShadows) {
        const BumpSurface two{.map = &map, .shadow = shadow, .tiles = Vec2(2)};
        const auto lit = [&](const Vec3& l) {
            return draw(makeQuad(), facing(), {true, glm::normalize(l), Rgb(1)}, two);
        };
        const Image picture = lit({0.8, 0.3, 0.5}), fromLeft = lit({-0.8, 0.3, 0.5}), fromBelow = lit({0.8, -0.3, 0.5});
        double contrast = 0;
        int off = 0;
        for (int y = 0; y < kPixels; ++y)
            for (int x = 0; x < kPixels; ++x) {
                off += std::abs(luminanceAt(picture, x, y) - luminanceAt(fromLeft, kPixels - 1 - x, y)) > 1e-3;
                off += std::abs(luminanceAt(picture, x, y) - luminanceAt(fromBelow, x, kPixels - 1 - y)) > 1e-3;
                contrast = std::max(contrast, std::abs(luminanceAt(picture, x, y) - luminanceAt(fromLeft, x, y)));
            }
        EXPECT_LE(off, kPixels) << "rounding at edges";
        EXPECT_GT(contrast, 0.1);
    }
}

TEST_F(Bump, CurvedMeshesKeepTheirTerminator) {
    const GpuBump map(bake(hills(32, 32, Wrap::Repeat)));
    const Vec3 light = glm::normalize(Vec3(0.9, 0.2, 0.4));
    for (const BumpShadow shadow : {BumpShadow::None, BumpShadow::Ellipse, BumpShadow::HardHorizon}) {
        const Image picture = draw(makeSphere(1, 128, 64), facing(), {true, light, Rgb(1)},
                                   {.map = &map, .shadow = shadow, .tiles = Vec2(8, 4)});
        int bright = 0, facingPixels = 0;
        for (int y = 0; y < kPixels; ++y)
            for (int x = 0; x < kPixels; ++x) {
                const Vec2 p(2 * (x + 0.5) / kPixels - 1, 1 - 2 * (y + 0.5) / kPixels);
                if (glm::length(p) > 0.97) continue;
                const double cosine = glm::dot(Vec3(p, std::sqrt(1 - glm::dot(p, p))), light);
                if (cosine < -0.01) {
                    EXPECT_EQ(luminanceAt(picture, x, y), 0) << x << " " << y;
                }
                if (cosine > 0.5) ++facingPixels, bright += luminanceAt(picture, x, y) > 0;
                EXPECT_TRUE(std::isfinite(luminanceAt(picture, x, y)));
            }
        EXPECT_GT(bright, 0.9 * facingPixels);
    }
}

TEST_F(Bump, AllLitAndAllDarkEllipses) {
    BumpMaps maps = bake(hills(16, 16, Wrap::Repeat));
    const auto fill = [&](const Rgb& offset) {
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                maps.ellipses->shape.setRgb(x, y, {0, 0, 0}), maps.ellipses->offset.setRgb(x, y, offset);
        return GpuBump(maps);
    };
    const GpuBump lit = fill({0, 0, 1}), dark = fill({2, 0, 0});
    const Light light{true, glm::normalize(Vec3(0.7, 0.2, 0.4)), Rgb(1)};
    for (const double tiles : {1.0, 20.0})
        for (const BumpShadow shadow : {BumpShadow::HardEllipse, BumpShadow::Ellipse}) {
            const Vec2 t(tiles);
            expectNear(draw(makeQuad(), facing(), light, {.map = &lit, .shadow = shadow, .tiles = t}),
                       draw(makeQuad(), facing(), light, {.map = &lit, .shadow = BumpShadow::None, .tiles = t}), 1e-6);
            const Image black = draw(makeQuad(), facing(), light, {.map = &dark, .shadow = shadow, .tiles = t});
            for (const float v : black.data()) EXPECT_EQ(v, 0);
        }
}

TEST_F(Bump, LightsInThePlaneAndStraightAbove) {
    const GpuBump map(bake(hills(16, 16, Wrap::Repeat)));
    for (const BumpShadow shadow : {BumpShadow::None, BumpShadow::HardEllipse, BumpShadow::Ellipse,
                                    BumpShadow::HardHorizon, BumpShadow::Horizon}) {
        const BumpSurface relief{.map = &map, .shadow = shadow};
        for (const Vec3& l : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)}) {
            const Image picture = draw(makeQuad(), facing(), {true, l, Rgb(1)}, relief);
            for (const float v : picture.data()) EXPECT_EQ(v, 0);
        }
        const Image above = draw(makeQuad(), facing(), {true, {0, 0, 1}, Rgb(1)}, relief);
        int litPixels = 0;
        for (int y = 0; y < kPixels; ++y)
            for (int x = 0; x < kPixels; ++x) litPixels += luminanceAt(above, x, y) > 0.05;
        EXPECT_GT(litPixels, 0.95 * kPixels * kPixels);
    }
}

// With no lamp the picture is the ambient light times the share of the sky.
TEST_F(Bump, SkyScalesAmbientAndDiffuseSurroundings) {
    const BumpMaps maps = bake(hills(32, 32, Wrap::Repeat));
    const GpuBump map(maps);
    const BumpSurface relief{.map = &map, .shadow = BumpShadow::Ellipse};
    const Image ambient = draw(makeQuad(), LitView{facing(), {}, Rgb(0.5)}, relief);
    EnvMap constant(EnvLayout::Octahedral, 4);
    for (float& v : constant.image.data()) v = 2;
    const GpuEnvironment environment(constant);
    EnvironmentSurface surface;
    surface.diffuse = {&environment, 0, Rgb(0.25)};
    const RenderTarget target({.width = kPixels, .height = kPixels});
    target.clear();
    renderEnvironment(loader_, target, GpuMesh(makeQuad()), facing(), surface, relief);
    const Image surrounded = target.read();
    double least = 1;
    for (int y = 0; y < kPixels; y += 3)
        for (int x = 0; x < kPixels; x += 3) {
            const Vec2 uv = uvOf(x, y, Vec2(1));
            const double sky = sampleWrapped(maps.ellipses->offset, uv.x, uv.y, Wrap::Repeat)[2];
            least = std::min(least, sky);
            EXPECT_NEAR(luminanceAt(ambient, x, y), 0.5 * sky, kSampler);
            EXPECT_NEAR(luminanceAt(surrounded, x, y), 0.5 * sky, kSampler);
        }
    EXPECT_LT(least, 0.8);
}

TEST_F(Bump, IndirectLightIsAddedTimesTheLight) {
    const GpuBump map(bake(hills(16, 16, Wrap::Repeat)));
    Image ramp(2, 1, 3);
    ramp.setRgb(0, 0, {0.1, 0.2, 0.3});
    ramp.setRgb(1, 0, {0.5, 0.6, 0.7});
    const Texture texture(ramp);  // nearest
    const LitView view{facing(), {{true, {0, 0, 1}, Rgb(1)}, {false, {0.5, 0, 2}, Rgb(3, 2, 1)}}};
    BumpSurface relief{.map = &map};
    const Image without = draw(makeQuad(), view, relief);
    relief.indirect = texture.name();
    relief.indirectLight = 1;
    const Image with = draw(makeQuad(), view, relief);
    for (int x = 3; x < kPixels; x += 20) {
        const Vec3 point((x + 0.5) / kPixels * 2 - 1, 1 - (40 + 0.5) / kPixels * 2, 0), away = Vec3(0.5, 0, 2) - point;
        const Rgb expected = ramp.rgb(x < kPixels / 2 ? 0 : 1, 0) * Rgb(3, 2, 1) / glm::dot(away, away);
        EXPECT_LT(glm::length(with.rgb(x, 40) - without.rgb(x, 40) - expected), 1e-5) << x;
    }
}

TEST_F(Bump, RoughnessOfTheReliefWidensMicrofacets) {
    BumpMaps maps = flat();
    maps.normals->levels.assign(1, Image(8, 8, 4));
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            maps.normals->levels[0].setRgb(x, y, {0, 0, 1}), maps.normals->levels[0].at(x, y, 3) = 0.25f;
    const GpuBump map(maps);
    const Light light{true, glm::normalize(Vec3(0.3, 0.2, 1)), Rgb(1)};
    for (const auto& [narrow, wide] : {std::pair{"ggx:alphax=0.3,alphay=0.6", "ggx:alphax=0.390512483795,alphay=0.65"},
                                       {"torrance-sparrow:alpha=0.3", "torrance-sparrow:alpha=0.390512483795"}}) {
        const BumpSurface plain{.map = &map};
        BumpSurface rough = plain;
        rough.roughness = true;
        const Image truth = draw(makeSphere(), facing(), light, plain, wide);
        expectNear(draw(makeSphere(), facing(), light, rough, narrow), truth, 1e-4);
        EXPECT_GT(std::abs(luminanceAt(draw(makeSphere(), facing(), light, plain, narrow), 74, 58) -
                           luminanceAt(truth, 74, 58)),
                  2e-3);
    }
}

// A linear filter, two levels blended: only the levels' steps may differ.
TEST_F(Bump, BlendedLevelsAndFloatTextures) {
    const BumpMaps maps = bake(hills(32, 32, Wrap::Repeat));
    const GpuBump half(maps), full(maps, {.format = TexelFormat::Float}), blended(maps, {.blendLevels = true});
    EXPECT_EQ(full.bytes(), 2 * half.bytes());
    EXPECT_EQ(half.width(), 32);
    EXPECT_EQ(half.height(), 32);
    const Light light{true, glm::normalize(Vec3(0.7, 0.2, 0.4)), Rgb(1)};
    for (const BumpShadow shadow : {BumpShadow::None, BumpShadow::Ellipse, BumpShadow::Horizon}) {
        const auto at = [&](const GpuBump& map, double tiles) {
            return draw(makeQuad(), facing(), light, {.map = &map, .shadow = shadow, .tiles = Vec2(tiles)});
        };
        expectNear(at(half, 1), at(blended, 1), 0);
        expectNear(at(half, 1), at(full, 1), 0.3);  // an edge's pixels may turn over
    }
}

TEST_F(Bump, RejectsWhatItCannotDraw) {
    BumpMaps maps = flat();
    EXPECT_THROW(GpuBump(maps, {.format = TexelFormat::Unorm8}), std::invalid_argument);
    BumpMaps bare = maps;
    bare.ellipses.reset();
    bare.horizons.reset();
    const GpuBump map(maps), normals(bare);
    bare.normals.reset();
    EXPECT_THROW(GpuBump{bare}, std::invalid_argument);
    maps.ellipses->shape.at(0, 0, 0) = 1e6f;
    EXPECT_THROW(GpuBump{maps}, StorageError);
    for (const BumpShadow shadow : kShadows)
        EXPECT_THROW(bumpDefines(BumpSurface{.map = &normals, .shadow = shadow}), std::invalid_argument);
    EXPECT_NO_THROW(bumpDefines({.map = &normals, .shadow = BumpShadow::None}));
    EXPECT_THROW(bumpDefines({.map = &map, .tiles = Vec2(0, 1)}), std::invalid_argument);
    EXPECT_THROW(bumpDefines({.map = &map, .roughness = true}), std::invalid_argument);
    EXPECT_THROW(bumpDefines({.map = &map, .indirect = 1, .indirectLight = -1}), std::invalid_argument);
    EXPECT_TRUE(bumpDefines({}).empty());
}

}  // namespace
}  // namespace nacre
