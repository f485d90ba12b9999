// Methods `single-lobe` (Phong, Blinn–Phong, cosine lobes with diffuse and ambient inside one texture) and `tangent`
// (Banks). HSE section 1.1 and eq. 4.
#include <fmt/format.h>

#include "core/error.hpp"
#include "factorize/mappings.hpp"
#include "factorize/methods.hpp"

namespace nacre {

FactoredBrdf factorizeSingleLobe(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options) {
    require(r.singleLobe.has_value(),
            fmt::format("factorize: method single-lobe needs a model with one lobe, found {}", r.source));
    const SingleLobePieces& pieces = *r.singleLobe;
    const bool axis = pieces.argument == SingleLobePieces::Argument::Axis;
    // s^n is half its peak at w = √(1 − s) = √(ln 2 / n): a few times that falls in the middle of the u axis.
    const double w0 = std::clamp(2.5 / std::sqrt(std::max(pieces.exponent, 1.0)), 1e-3, 4.0);

    // The radiance is ambient + cosα·f(s): linear in cosα, so that two rows are exact.
    Image image(sizes.first.x, 2, 3);
    for (int x = 0; x < image.width(); ++x) {
        const double s = inverseLobe(static_cast<double>(x) / std::max(1, image.width() - 1), w0);
        image.setRgb(x, 0, pieces.ambient);
        image.setRgb(x, 1, pieces.ambient + pieces.diffuse + pieces.lobe(s));
    }
    FactoredBrdf out;
    out.form = FactoredForm::SingleLobe;
    out.method = "single-lobe";
    const bool unitAxis = glm::abs(pieces.axis) == Vec3(1);
    out.params[0] = {static_cast<float>(w0), axis ? 1 : 0, unitAxis ? 0 : 1, 0};
    out.params[1] = glm::vec4(glm::vec3(pieces.ambient), 0);
    out.params[2] = glm::vec4(glm::vec3(pieces.axis), 0);
    out.textures.push_back(makeScaledTexture("radiance", "lobe", std::move(image), options.format));
    out.fetches = 1;
    return out;
}

FactoredBrdf factorizeTangent(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options) {
    require(r.tangent.has_value(), fmt::format("factorize: method tangent needs the model banks, found {}", r.source));
    Image image(sizes.first.x, sizes.first.y, 3);
    const auto dotOf = [](int i, int size) { return 2.0 * i / std::max(1, size - 1) - 1; };
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            image.setRgb(x, y, r.tangent->value(dotOf(x, image.width()), dotOf(y, image.height())));
    FactoredBrdf out;
    out.form = FactoredForm::Tangent;
    out.method = "tangent";
    out.textures.push_back(makeScaledTexture("f", "tangent", std::move(image), options.format));
    out.fetches = 1;
    return out;
}

}  // namespace nacre
