// Every factored form in GLSL against its C++ twin, on assets baked here.
#include <gtest/gtest.h>

#include <functional>
#include <ostream>

#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "shading/gpu_factored_brdf.hpp"

namespace nacre {
namespace {

/// How an asset comes about: by a baker, or with arbitrary smooth tables, which reach every branch of a form at no
/// cost.
struct FactoredCase {
    std::string name;
    std::function<FactoredBrdf()> make;
    bool poleIsUnstable = false;  ///< azimuths about h are rounding at h = n, and arbitrary tables show it
    double relative = 2e-3;       ///< the issue's bar, GLSL against C++ for half assets
    double ofMedian = 1e-4;       ///< where terms of either sign cancel, their size counts, not the result's
};

FactoredBrdf bake(const std::string& model, const std::string& method, int terms = 0,
                  TexelFormat format = TexelFormat::Half) {
    FactorizeOptions options;
    options.method = method;
    options.size = method == "analytic" ? 8 : method == "svd" ? 16 : 64;
    options.terms = terms;
    options.format = format;
    return factorize(makeModel(model), options);
}

/// Sums of a few waves of about that size, no channel like another.
AssetTexture waves(int width, int height, int channels, int seed, double size) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) {
                const double u = (x + 0.5) / width, v = (y + 0.5) / height, phase = 1.7 * seed + 2.3 * c;
                image.at(x, y, c) = static_cast<float>(
                    size * (std::sin(3 * u + phase) + std::cos(4 * v - phase) + 0.5 * std::sin(9 * u * v + 3 * phase)));
            }
    AssetTexture texture = makeTexture("t" + std::to_string(seed), "test", image, TexelFormat::Half);
    texture.scale = {0.9f, 1.1f, 0.8f, 1.2f};  // as a baker may divide a table by a constant
    texture.bias = {0.1f, -0.2f, 0.3f, -0.4f};
    return texture;
}

FactoredBrdf arbitrary(FactoredForm form, int textures, const std::vector<glm::vec4>& first) {
    FactoredBrdf brdf;
    brdf.form = form;
    for (int i = 0; i < textures; ++i) brdf.textures.push_back(waves(24, 17 + i, 4, i + 1, 1.5));
    for (std::size_t i = 0; i < brdf.params.size(); ++i)
        brdf.params[i] =
            i < first.size() ? first[i] : glm::vec4(0.3f, 0.9f, 0.6f, 0.1f) / static_cast<float>(1 + i % 5);
    return brdf;
}

FactoredBrdf arbitraryHalfDiff(HalfDiffLayout layout) {
    return arbitrary(FactoredForm::HalfDiff, layout == HalfDiffLayout::Compact ? 1 : 2,
                     {{0.2f, static_cast<float>(layout), 0, 0}});
}

FactoredBrdf arbitraryHomomorphic(bool quadrant, bool directions, bool elevations, int shadowing) {
    return arbitrary(FactoredForm::Homomorphic, 1 + directions + elevations,
                     {{1 / 0.1f, 1 / 0.4f, quadrant ? 1 : 0, directions ? 1 : 0},
                      {0.5f, 0.25f, elevations ? 1 : 0, 1.5f},
                      {0.1f, 0.2f, 0.3f, static_cast<float>(shadowing)}});
}

FactoredBrdf arbitrarySeparable(int terms, SeparableArguments arguments, SeparableStorage storage, bool quadrant) {
    return arbitrary(FactoredForm::Separable, terms * (arguments == SeparableArguments::Symmetric ? 1 : 2),
                     {glm::vec4(terms, static_cast<int>(arguments), static_cast<int>(storage), quadrant),
                      {1 / 0.2f, 1 / 0.3f, 0, 0}});
}

std::vector<glm::vec4> onGpu(const FactoredBrdf& brdf, const std::vector<DirectionPair>& pairs, Glsl dialect,
                             bool specialize = true) {
    const GpuFactoredBrdf gpu(brdf);
    ShaderDefines defines = gpu.defines();
    if (!specialize) defines.resize(1);  // NACRE_FORM alone: the variant is chosen at run time
    return test::gpuEvaluate(
        {.code = "#include \"nacre/bind/factored_brdf.glsl\"\n"
                 "vec4 evaluate(vec3 wi, vec3 wo) { return vec4(nacre_factored_brdf(wi, wo), 1.0); }\n",
         .defines = defines,
         .bind = [&](const Program& program) { gpu.bind(program, 2); },
         .dialect = dialect},
        pairs);
}

class GpuFactored : public ::testing::TestWithParam<FactoredCase> {};

/// Directions at and below the horizon, exactly grazing ones and opposite ones: 0, or finite.
void expectZeroBelowTheHorizon(const FactoredBrdf& brdf) {
    const Vec3 up(0, 0, 1), flat(1, 0, 0), down = glm::normalize(Vec3(0.5, 0, -1)),
                                           low = glm::normalize(Vec3(-1, 0, 1e-6));
    const std::vector<DirectionPair> dark = {{up, flat}, {flat, up}, {flat, flat},
                                             {up, down}, {down, up}, {down, down}};
    const std::vector<DirectionPair> lit = {
        {up, up}, {low, low}, {low, up}, {up, low}, {low, glm::normalize(Vec3(1, 0, 1e-6))}};
    for (const glm::vec4& value : onGpu(brdf, dark, Glsl::V330)) EXPECT_EQ(glm::vec3(value), glm::vec3(0));
    for (const glm::vec4& value : onGpu(brdf, lit, Glsl::V330)) EXPECT_TRUE(isFinite(Vec3(glm::vec3(value))));
}

double medianOf(const FactoredBrdf& brdf, const std::vector<DirectionPair>& pairs) {
    std::vector<double> values;
    for (const DirectionPair& pair : pairs) values.push_back(maxComponent(glm::abs(evaluate(brdf, pair.wi, pair.wo))));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

TEST_P(GpuFactored, MatchesCpp) {
    const FactoredBrdf brdf = GetParam().make();
    const std::vector<DirectionPair> pairs = test::testPairs(4000);
    const double median = medianOf(brdf, pairs);
    EXPECT_GT(median, 0);
    for (const auto& [api, dialect] : {std::pair{GlApi::Core33, Glsl::V330}, {GlApi::Es3, Glsl::Es300}}) {
        test::context(api);
        const auto values = onGpu(brdf, pairs, dialect);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const Vec3 h = halfVector(pairs[i].wi, pairs[i].wo);
            if (GetParam().poleIsUnstable && std::hypot(h.x, h.y) < 1e-5) continue;
            const Rgb f = evaluate(brdf, pairs[i].wi, pairs[i].wo);
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(std::isfinite(values[i][c])) << i;
                ASSERT_NEAR(values[i][c], f[c], GetParam().relative * std::abs(f[c]) + GetParam().ofMedian * median)
                    << i << ": wi.z " << pairs[i].wi.z << " wo.z " << pairs[i].wo.z << " channel " << c << " as "
                    << toString(dialect);
            }
        }
    }
    test::context();
    expectZeroBelowTheHorizon(brdf);
    const auto special = onGpu(brdf, pairs, Glsl::V330), general = onGpu(brdf, pairs, Glsl::V330, false);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(special[i][c], general[i][c], 1e-4 * (std::abs(general[i][c]) + median)) << i;
}

std::vector<FactoredCase> cases() {
    std::vector<FactoredCase> out;
    const std::pair<const char*, HalfDiffLayout> layouts[] = {{"product", HalfDiffLayout::Product},
                                                              {"harmonics", HalfDiffLayout::Harmonics},
                                                              {"compact", HalfDiffLayout::Compact},
                                                              {"grazing", HalfDiffLayout::Grazing}};
    for (const auto& [name, layout] : layouts)
        out.push_back({std::string("half_diff_") + name, [layout = layout] { return arbitraryHalfDiff(layout); }});
    for (int i = 0; i < 8; ++i)
        out.push_back({"homomorphic_" + std::to_string(i),
                       [i] { return arbitraryHomomorphic((i & 1) != 0, (i & 2) != 0, (i & 4) != 0, i % 3); }});
    for (int arguments = 0; arguments < 4; ++arguments)
        for (int storage = 0; storage < 3; ++storage) {
            const auto a = static_cast<SeparableArguments>(arguments);
            const auto s = static_cast<SeparableStorage>(storage);
            if (a == SeparableArguments::Symmetric && s == SeparableStorage::Factors) continue;  // there is none
            for (int terms = 1; terms <= 2; ++terms)
                out.push_back(
                    {"separable_" + std::to_string(arguments) + std::to_string(storage) + std::to_string(terms),
                     [=] { return arbitrarySeparable(terms, a, s, terms == 2); },
                     a == SeparableArguments::HalfDifference});
        }
    const auto baked = [&out](const std::string& name, const std::string& model, const std::string& method) {
        out.push_back({name, [=] { return bake(model, method); }});
    };
    baked("analytic", "torrance-sparrow:alpha=0.3", "analytic");
    baked("cosine", "torrance-sparrow:alpha=0.3,f=conductor,eta=0.2/0.9/1.1,k=3.9/2.4/2.2,kd=0.3", "cosine");
    baked("svd", "torrance-sparrow:alpha=0.3", "svd");
    baked("svd_anisotropic", "ggx:alphax=0.2,alphay=0.5", "svd");
    baked("phong", "phong:n=40,kd=0.2/0.3/0.4", "single-lobe");
    baked("blinn_phong", "blinn-phong:n=1000,ks=0.5/0.6/0.7,ambient=0.1", "single-lobe");
    baked("cosine_lobe", "cosine-lobe:cx=-0.9,cy=-0.7,cz=0.8,n=20", "single-lobe");
    baked("banks", "banks:n=30,kd=0.1/0.2/0.3", "tangent");
    out.push_back({"cosine_float", [] { return bake("torrance-sparrow:alpha=0.3", "cosine", 0, TexelFormat::Float); }});
    out.push_back({"cosine_unorm8",
                   [] { return bake("torrance-sparrow:alpha=0.3,kd=0.2", "cosine", 0, TexelFormat::Unorm8); }, false,
                   5e-2, 5e-2});  // llvmpipe filters 8-bit textures with 256 weights: 3.8e-3 of the range
    return out;
}

std::string caseName(const ::testing::TestParamInfo<FactoredCase>& at) { return at.param.name; }
void PrintTo(const FactoredCase& at, std::ostream* out) { *out << at.name; }

INSTANTIATE_TEST_SUITE_P(Assets, GpuFactored, ::testing::ValuesIn(cases()), caseName);

}  // namespace
}  // namespace nacre
