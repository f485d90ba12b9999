#include "bench/gpu_lab.hpp"

#include <array>
#include <limits>

#include "core/sampling.hpp"
#include "factorize/models/models.hpp"
#include "shading/draw.hpp"
#include "shading/primitives.hpp"
#include "shading/texture.hpp"
#include "shading/timing.hpp"

namespace nacre::bench {

namespace {

constexpr int kPixels = 384, kLights = 4;
constexpr int kPairsARow = 256;
constexpr const char* kDirectStandIn = "torrance-sparrow:d=beckmann,g=smith,alpha=0.2,f=dielectric";

LitView lightedView() {
    LitView view;
    view.camera.orthographic = true;
    for (int i = 0; i < kLights; ++i)
        view.lights.push_back({true, sphericalDirection(0.2 + 0.2 * i, 1.3 * i), Rgb(1.0 / kLights)});
    return view;
}

const char* kPairShader = R"(
#include "nacre/bind/brdf.glsl"
uniform sampler2D bench_wi;
uniform sampler2D bench_wo;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    color = vec4(nacre_brdf(texelFetch(bench_wi, at, 0).xyz, texelFetch(bench_wo, at, 0).xyz), 1.0);
}
)";

/// The single-precision directions that both sides are given.
Image directionImage(const std::vector<DirectionPair>& pairs, Vec3 DirectionPair::*which) {
    const int rows = static_cast<int>((pairs.size() + kPairsARow - 1) / kPairsARow);
    Image out(kPairsARow, rows, 4);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out.data()[4 * i + c] = static_cast<float>((pairs[i].*which)[static_cast<int>(c)]);
    return out;
}

Vec3 direction(const Image& image, std::size_t i) {
    return {image.data()[4 * i], image.data()[4 * i + 1], image.data()[4 * i + 2]};
}

}  // namespace

GpuLab::GpuLab(int repeats)
    : target_({.width = kPixels, .height = kPixels}),
      mesh_(makeSphere(1.0f, 64, 32)),
      view_(lightedView()),
      repeats_(repeats) {}

std::string GpuLab::frameText() {
    return "a sphere that fills " + std::to_string(kPixels) + "² pixels under " + std::to_string(kLights) +
           " directional lights, vectors made per pixel";
}

FrameCost GpuLab::cost(const FactoredBrdf& brdf, const Reflectance& reflectance) {
    const GpuFactoredBrdf factored(brdf);
    std::optional<GpuDirectBrdf> direct = directBrdf(reflectance);
    const bool own = direct.has_value();
    if (!own) direct = directBrdf(makeModel(kDirectStandIn));
    const std::array<std::function<void()>, 2> frames = {
        [&] { target_.clear(), renderFactored(loader_, target_, mesh_, view_, factored); },
        [&] { target_.clear(), renderDirect(loader_, target_, mesh_, view_, *direct); }};
    const std::vector<double> seconds = medianFrameSeconds(frames, {.repeats = repeats_});
    return {1000 * seconds[0], 1000 * seconds[1], own ? reflectance.source : kDirectStandIn};
}

double GpuLab::glslDeviation(const FactoredBrdf& brdf, const std::vector<DirectionPair>& pairs) {
    const Image wiImage = directionImage(pairs, &DirectionPair::wi),
                woImage = directionImage(pairs, &DirectionPair::wo);
    const Texture wi(wiImage), wo(woImage);
    const GpuFactoredBrdf factored(brdf);
    const Program program = loader_.compile("fullscreen.vert.glsl", {"bench pairs", kPairShader}, factored.defines());
    const RenderTarget target({.width = kPairsARow, .height = wiImage.height(), .depth = false});
    target.clear();
    factored.bind(program, 2);
    program.set("bench_wi", 0);
    program.set("bench_wo", 1);
    wi.bind(0);
    wo.bind(1);
    drawFullscreen(VertexArray());
    const Image shown = target.read(3);
    std::vector<Rgb> twin;
    double largest = 0, worst = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        twin.push_back(evaluate(brdf, direction(wiImage, i), direction(woImage, i)));
        largest = std::max(largest, maxComponent(twin.back()));
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {  // texel row 0 is the lowest row of pixels
        const int x = static_cast<int>(i) % kPairsARow, y = shown.height() - 1 - static_cast<int>(i) / kPairsARow;
        const Rgb value = shown.rgb(x, y);
        if (!isFinite(value)) return std::numeric_limits<double>::infinity();
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(value[c] - twin[i][c]) / (std::abs(twin[i][c]) + 1e-5 * largest + 1e-30));
    }
    return worst;
}

std::vector<DirectionPair> deviationPairs(std::size_t count) {
    std::vector<DirectionPair> out;
    for (std::size_t i = 1; i <= count; ++i) {
        const auto u = [&](unsigned base) { return radicalInverse(i, base); };
        DirectionPair pair{cosineHemisphere({u(2), u(3)}), cosineHemisphere({u(5), u(7)})};
        if (i % 5 == 0) pair.wi = sphericalDirection((90 - 2 * u(11)) * kPi / 180, 2 * kPi * u(3));
        if (i % 10 == 0) std::swap(pair.wi, pair.wo);
        out.push_back(pair);
    }
    return out;
}

}  // namespace nacre::bench
