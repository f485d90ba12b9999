// The window's tone mapping in GLSL against its C++ twin.
#include <gtest/gtest.h>

#include "gpu_evaluate.hpp"
#include "reference/tone.hpp"

namespace nacre {
namespace {

constexpr double kSinglePrecision = 1e-4;  // a power in 32 bits; a 255th is 4e-3

TEST(Tone, SrgbInGlslAndCpp) {
    test::context();
    const auto pairs = test::testPairs(1000);
    const auto values =
        test::gpuEvaluate({.code = "#include \"nacre/tone.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                                   "    return vec4(nacre_srgb_encode(wi * vec3(1.0, 0.01, 2.0)), 1.0);\n}\n"},
                          pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vec3 linear = pairs[i].wi * Vec3(1, 0.01, 2);  // negative, in the linear part, above 1
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(values[i][c], srgbEncode(linear[c]), kSinglePrecision) << i;
    }
}

}  // namespace
}  // namespace nacre
