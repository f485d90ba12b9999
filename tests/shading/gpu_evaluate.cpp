#include "gpu_evaluate.hpp"

#include <cstdlib>
#include <optional>

#include "core/sampling.hpp"
#include "shading/draw.hpp"
#include "shading/render_target.hpp"
#include "shading/texture.hpp"

namespace nacre::test {
namespace {

constexpr int kWidth = 256;  ///< pairs a row

const char* kMain = R"(
uniform sampler2D test_wi;
uniform sampler2D test_wo;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    color = evaluate(texelFetch(test_wi, at, 0).xyz, texelFetch(test_wo, at, 0).xyz);
}
)";

Image packDirections(std::span<const DirectionPair> pairs, int height, bool incident) {
    Image out(kWidth, height, 4);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (int c = 0; c < 3; ++c)
            out.data()[4 * i + static_cast<std::size_t>(c)] =
                static_cast<float>(incident ? pairs[i].wi[c] : pairs[i].wo[c]);
    return out;
}

}  // namespace

const Context& context(GlApi api) {
    // llvmpipe filters 8-bit textures with 256 weights, unless told to be exact before its first context
    setenv("GALLIVM_PERF", "no_aos_sampling", 0);
    static std::optional<Context> core45, core33, es3;  // kept until the program ends
    std::optional<Context>& kept = api == GlApi::Core45 ? core45 : api == GlApi::Core33 ? core33 : es3;
    if (!kept) kept.emplace(api);
    kept->makeCurrent();
    return *kept;
}

std::vector<glm::vec4> gpuEvaluate(const GpuFunction& function, std::span<const DirectionPair> pairs) {
    const int height = static_cast<int>((pairs.size() + kWidth - 1) / kWidth);
    const Texture wi(packDirections(pairs, height, true)), wo(packDirections(pairs, height, false));
    const ProgramLoader loader(function.dialect);
    const Program program = loader.compile("fullscreen.vert.glsl", {"test", function.code + kMain}, function.defines);
    const RenderTarget target({.width = kWidth, .height = height, .depth = false});
    target.clear();
    program.set("test_wi", 0);
    program.set("test_wo", 1);
    if (function.bind) function.bind(program);
    wi.bind(0);
    wo.bind(1);
    drawFullscreen(VertexArray());
    const Image pixels = target.read(4);
    std::vector<glm::vec4> out(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {  // read() turns rows upside down: texel row 0 is the lowest pixel
        const int x = static_cast<int>(i) % kWidth, y = height - 1 - static_cast<int>(i) / kWidth;
        out[i] = {pixels.at(x, y, 0), pixels.at(x, y, 1), pixels.at(x, y, 2), pixels.at(x, y, 3)};
    }
    return out;
}

std::vector<DirectionPair> testPairs(std::size_t count) {
    std::vector<DirectionPair> out;
    for (std::size_t i = 1; i <= count; ++i)
        out.push_back({cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)}),
                       cosineHemisphere({radicalInverse(i, 5), radicalInverse(i, 7)})});
    const auto rad = [](double degrees) { return degrees * kPi / 180; };
    for (double in : {0., 45., 80., 89., 89.9})
        for (double away : {0., 45., 80., 89., 89.9})
            for (double apart : {0., 90., 180., 237.})
                out.push_back({sphericalDirection(rad(in), 0.3), sphericalDirection(rad(away), 0.3 + rad(apart))});
    return out;
}

}  // namespace nacre::test
