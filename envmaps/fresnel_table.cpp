#include "envmaps/fresnel_table.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/fresnel.hpp"

namespace nacre {

static void check(const FresnelIndex& index) {
    for (int c = 0; c < 3; ++c) {
        require(std::isfinite(index.eta[c]) && index.eta[c] > 0,
                fmt::format("fresnel: expected eta > 0, found {}", index.eta[c]));
        require(std::isfinite(index.k[c]) && index.k[c] >= 0,
                fmt::format("fresnel: expected k >= 0, found {}", index.k[c]));
    }
}

Rgb fresnelExact(const FresnelIndex& index, double cosTheta) {
    Rgb out;
    for (int c = 0; c < 3; ++c)
        out[c] = index.k[c] == 0 ? fresnelDielectric(cosTheta, index.eta[c])
                                 : fresnelConductor(cosTheta, index.eta[c], index.k[c]);
    return out;
}

AssetTexture bakeFresnelTable(const FresnelIndex& index, int size, TexelFormat format) {
    check(index);
    require(size >= 2 && size <= 16384, fmt::format("fresnel: size must be 2 to 16384, found {}", size));
    const bool grey = index.eta == Rgb(index.eta.x) && index.k == Rgb(index.k.x);
    Image image(size, 1, grey ? 1 : 3);
    for (int x = 0; x < size; ++x) image.setRgb(x, 0, fresnelExact(index, sqr(x / (size - 1.0))));
    return makeTexture("fresnel", "sqrt_cos", image, format);
}

Rgb lookupFresnel(const AssetTexture& table, double cosTheta) {
    const float size = static_cast<float>(table.image.width());
    const float u = (static_cast<float>(std::sqrt(clamp01(cosTheta))) * (size - 1) + 0.5f) / size;
    const glm::vec4 texel = table.bias + table.scale * sampleBilinear(table.image, u, 0.5f);
    return table.image.channels() == 1 ? Rgb(texel.x) : Rgb(texel);
}

}  // namespace nacre
