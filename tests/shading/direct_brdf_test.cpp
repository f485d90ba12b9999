// The models in GLSL against the models in C++.
#include <gtest/gtest.h>

#include <cstdlib>

#include "factorize/models/models.hpp"
#include "factorize/models/sgd.hpp"
#include "gpu_evaluate.hpp"
#include "shading/gpu_direct_brdf.hpp"

namespace nacre {
namespace {

const char* kCode =
    "#include \"nacre/bind/direct_brdf.glsl\"\n"
    "vec4 evaluate(vec3 wi, vec3 wo) { return vec4(nacre_direct_brdf(wi, wo), 1.0); }\n";

/// testPairs, and pairs about the mirror direction at angles of lobes from 1e-4 to 1, where narrow lobes live.
std::vector<DirectionPair> lobePairs() {
    std::vector<DirectionPair> out = test::testPairs(2000);
    for (double width : {1e-4, 1e-3, 1e-2, 1e-1})
        for (double theta : {0., 0.7, 1.4})
            for (int k = 0; k < 8; ++k) {
                const DirectionPair pair = fromHalfDifference({width * (1 + k) / 3, 0.9 * k, theta, 0.4 + k});
                if (pair.wi.z > 0 && pair.wo.z > 0) out.push_back(pair);
            }
    return out;
}

class ModelTest : public ::testing::TestWithParam<const char*> {};

// Single precision moves h by 1e-7, so D moves by 1e-7/alpha of its peak; llvmpipe's exp, log and atan add 1e-5 times
// their argument. Hence relative to the value plus a small share of the largest one.
constexpr double kRelative = 2e-3;
constexpr double kOfPeak = 1e-5;

void expectMatch(const std::string& text) {
    const Reflectance model = makeModel(text);
    const std::optional<GpuDirectBrdf> direct = directBrdf(model);
    ASSERT_TRUE(direct.has_value());
    const std::vector<DirectionPair> pairs = lobePairs();
    test::context();
    const auto values = test::gpuEvaluate(
        {.code = kCode, .defines = direct->defines(), .bind = [&](const Program& program) { direct->bind(program); }},
        pairs);
    double peak = 0;
    for (const DirectionPair& pair : pairs) peak = std::max(peak, maxComponent(model.f(pair.wi, pair.wo)));
    EXPECT_GT(peak, 0);
    const bool noPole =
        text.rfind("schlick:", 0) == 0;  // A(w) jumps with the azimuth of h, which rounding decides there
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vec3 h = halfVector(pairs[i].wi, pairs[i].wo);
        if (noPole && std::hypot(h.x, h.y) < 1e-5) continue;
        const Rgb f = model.f(pairs[i].wi, pairs[i].wo);
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(values[i][c], f[c], kRelative * f[c] + kOfPeak * peak)
                << i << ": wi.z " << pairs[i].wi.z << " wo.z " << pairs[i].wo.z << " channel " << c;
    }
}

TEST_P(ModelTest, GlslMatchesCpp) { expectMatch(GetParam()); }

std::string testName(const ::testing::TestParamInfo<const char*>& at) {
    std::string name = at.param;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return std::to_string(at.index) + "_" + name;
}

INSTANTIATE_TEST_SUITE_P(DirectBrdf, ModelTest,
                         ::testing::Values("lambert:kd=0.2/0.3/0.4", "phong:n=50,kd=0.1", "phong:n=100000", "phong:n=1",
                                           "blinn-phong:n=20,ks=0.9/0.5/0.2", "blinn-phong:n=1000000",
                                           "cosine-lobe:cx=-0.8,cy=-0.9,cz=0.95,n=20", "torrance-sparrow:alpha=0.2",
                                           "torrance-sparrow:alpha=0.001", "torrance-sparrow:alpha=1",
                                           "torrance-sparrow:d=ggx,alpha=0.1,f=conductor,eta=0.2/0.9/1.1,k=3.9/2.4/2.2",
                                           "torrance-sparrow:d=gaussian,alpha=0.15,f=schlick,f0=0.9/0.6/0.3,kd=0.2",
                                           "torrance-sparrow:g=v-cavity,alpha=0.3,f=none", "torrance-sparrow:eta=200",
                                           "torrance-sparrow:f=conductor,eta=200,k=200", "cook-torrance:alpha=0.25",
                                           "ggx:alphax=0.1,alphay=0.4", "ggx:alphax=0.001,alphay=1,g=smith",
                                           "ward:alphax=0.1,alphay=0.3", "ward:variant=duer,alpha=0.2",
                                           "ward:variant=gmd,alphax=0.05,alphay=0.2,kd=0.3",
                                           "ashikhmin-shirley:nu=50,nv=500,rd=0.3", "ashikhmin-shirley:n=1000000",
                                           "schlick:r=0.05,p=0.4,kd=0.2", "schlick:r=0.000001", "banks:n=30",
                                           "banks:n=100000,kd=0.1/0.2/0.3"),
                         testName);

// All the published fits: exponents of 300, widths of 2e-4, masking that falls within a degree.
TEST(DirectBrdf, EveryPublishedFitMatches) {
    for (const SgdMaterial& material : sgdMaterials()) {
        SCOPED_TRACE(material.name);
        expectMatch(std::string("sgd:") + material.name);
        if (HasFatalFailure()) return;
    }
}

TEST(DirectBrdf, NoInterfaceReflectsNothing) {
    const std::optional<GpuDirectBrdf> direct = directBrdf(makeModel("torrance-sparrow:eta=1"));
    test::context();
    const auto bind = [&](const Program& program) { direct->bind(program); };
    for (const glm::vec4& value :
         test::gpuEvaluate({.code = kCode, .defines = direct->defines(), .bind = bind}, lobePairs()))
        EXPECT_EQ(value, glm::vec4(0, 0, 0, 1));
}

// A model that makeModel lists must not lose its baseline unnoticed.
TEST(DirectBrdf, EveryModelHasAShaderForm) {
    for (const ModelInfo& info : listModels()) EXPECT_TRUE(directBrdf(makeModel(info.name)).has_value()) << info.name;
}

}  // namespace
}  // namespace nacre
