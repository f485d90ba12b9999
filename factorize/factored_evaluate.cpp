// C++ twins of shaders/nacre/factored_*.glsl, one function a form. Single precision throughout: what the shader does.
#include <cmath>

#include "factorize/factored_brdf.hpp"
#include "factorize/mappings.hpp"

namespace nacre {
namespace {

constexpr float kMaxLog = 60;  // e^60: no BRDF reaches it, and squares of it stay finite

glm::vec4 lookup(const AssetTexture& texture, const glm::vec2& uv) {
    const float u = toTexelCentres(uv.x, texture.image.width()), v = toTexelCentres(uv.y, texture.image.height());
    return texture.bias + texture.scale * sampleBilinear(texture.image, u, v);
}

glm::vec3 expOf(const glm::vec3& y) { return glm::exp(glm::min(y, glm::vec3(kMaxLog))); }

glm::vec3 mix(const FactoredBrdf& b, int first, const glm::vec3& t) {  // colour columns params[first..first+2]
    return glm::vec3(b.params[first]) * t.x + glm::vec3(b.params[first + 1]) * t.y +
           glm::vec3(b.params[first + 2]) * t.z;
}

glm::vec3 halfDiff(const FactoredBrdf& b, const glm::vec3& wi, const glm::vec3& wo) {
    const HalfGeometry g = halfGeometry(wi, wo);
    const glm::vec2 uv = mapHalfDiff(g, b.params[0].x);
    const auto layout = static_cast<HalfDiffLayout>(static_cast<int>(b.params[0].y));
    const glm::vec4 t0 = lookup(b.textures[0], uv);
    glm::vec3 y;
    if (layout == HalfDiffLayout::Product) {
        y = mix(b, 2, glm::vec3(t0)) + lookup(b.textures[1], mapElevations(wi.z, wo.z)).x;
    } else {
        const float x = cosSquaredPhiD(g, wi, wo);
        if (layout == HalfDiffLayout::Harmonics) {
            const glm::vec4 t1 = lookup(b.textures[1], uv);
            y = mix(b, 2, {t0.x + x * (t0.y + x * (t0.z + x * t1.x)), t0.w + x * t1.y, t1.z + x * t1.w});
        } else {
            y = mix(b, 2, {t0.x + x * t0.y, t0.z, t0.w});
            if (layout == HalfDiffLayout::Grazing)
                y += mix(b, 2, glm::vec3(lookup(b.textures[1], mapElevations(wi.z, wo.z))));
        }
    }
    return glm::vec3(b.params[1]) + expOf(y);
}

glm::vec3 cosine(const FactoredBrdf& b, const glm::vec3& wi, const glm::vec3& wo) {
    const HalfGeometry g = halfGeometry(wi, wo);
    const glm::vec3 a = glm::vec3(lookup(b.textures[0], mapCosine(1.0f - g.oneMinusLh, g.h.z)));
    const float geometry = lookup(b.textures[1], mapCosine(wi.z, wo.z)).x;
    return glm::vec3(b.params[1]) + mix(b, 2, a) * (geometry / wi.z);
}

glm::vec3 singleLobe(const FactoredBrdf& b, const glm::vec3& wi, const glm::vec3& wo) {
    float oneMinusS = 0;
    if (b.params[0].y < 0.5f) {  // n·h: 1 − hz = sin²/(1 + hz)
        const HalfGeometry g = halfGeometry(wi, wo);
        oneMinusS = g.lengthXY * g.lengthXY / (1.0f + g.h.z);
    } else {  // |a − wo|²/2 for a = axis ⊗ wi: 1 − s = ((1 − |a|²) + |a − wo|²)/2, exact for a unit axis
        const glm::vec3 a = glm::vec3(b.params[2]) * wi, gap = a - wo;
        oneMinusS = 0.5f * (b.params[0].z * (1.0f - glm::dot(a, a)) + glm::dot(gap, gap));
    }
    const glm::vec3 t = glm::vec3(lookup(b.textures[0], {mapLobe(oneMinusS, b.params[0].x), wi.z}));
    return (t - glm::vec3(b.params[1])) / wi.z;
}

glm::vec3 tangent(const FactoredBrdf& b, const glm::vec3& wi, const glm::vec3& wo) {
    return glm::vec3(lookup(b.textures[0], mapTangent(wi.x, wo.x)));
}

glm::vec3 homomorphic(const FactoredBrdf& b, const glm::vec3& wi, const glm::vec3& wo) {
    const bool quadrant = b.params[0].z > 0.5f;
    const HalfGeometry g = halfGeometry(wi, wo);
    const float w = g.oneMinusLh;
    glm::vec3 c(0);  // Fresnel's polynomial, params[3..11]
    for (int k = 11; k >= 3; --k) c = c * w + glm::vec3(b.params[k]);
    glm::vec3 t(lookup(b.textures[0], mapScaledSlope(g.h, glm::vec2(b.params[0]), quadrant)));
    std::size_t next = 1;
    if (b.params[0].w > 0.5f) {
        t += glm::vec3(lookup(b.textures[1], mapLambertDisk(wi, quadrant)) +
                       lookup(b.textures[1], mapLambertDisk(wo, quadrant)));
        next = 2;
    }
    const float powers = b.params[1].x * std::log(std::max(wi.z, wo.z)) + b.params[1].y * std::log(wi.z * wo.z) +
                         b.params[1].w * std::log(std::max(1.0f - w, 1e-6f));
    const auto shadowing = static_cast<SmithShadowing>(static_cast<int>(b.params[2].w));
    const float smith = smithDenominator(shadowing, 1.0f / glm::vec2(b.params[0]), wi, wo);
    glm::vec3 f = glm::vec3(b.params[2]) + glm::max(c, glm::vec3(0)) * expOf(mix(b, 12, t) - powers) / smith;
    if (b.params[1].z > 0.5f) f += glm::vec3(lookup(b.textures[next], mapElevations(wi.z, wo.z)));
    return f;
}

glm::vec3 separable(const FactoredBrdf& b, const glm::vec3& wi, const glm::vec3& wo) {
    const auto arguments = static_cast<SeparableArguments>(static_cast<int>(b.params[0].y));
    const auto storage = static_cast<SeparableStorage>(static_cast<int>(b.params[0].z));
    const auto [x, y] = separableCoordinates(arguments, b.params[0].w > 0.5f, glm::vec2(b.params[1]), wi, wo);
    glm::vec3 f(0);
    if (arguments == SeparableArguments::Symmetric) {
        for (std::size_t k = 0; k < b.textures.size(); ++k) {
            const glm::vec4 a = lookup(b.textures[k], x) * lookup(b.textures[k], y);
            for (int c = 0; c < 4; ++c) f += glm::vec3(b.params[2 + 4 * k + c]) * a[c];
        }
    } else {
        for (std::size_t k = 0; 2 * k + 1 < b.textures.size(); ++k) {
            const glm::vec3 u(lookup(b.textures[2 * k], x)), v(lookup(b.textures[2 * k + 1], y));
            f += storage == SeparableStorage::Factors ? expOf(u + v) : u * v;
        }
    }
    return storage == SeparableStorage::Logarithm ? expOf(f) : glm::max(f, glm::vec3(0));
}

}  // namespace

std::pair<glm::vec2, glm::vec2> separableCoordinates(SeparableArguments arguments, bool quadrant,
                                                     const glm::vec2& inverseWidth, const glm::vec3& wi,
                                                     const glm::vec3& wo) {
    if (arguments == SeparableArguments::InOut || arguments == SeparableArguments::Symmetric)
        return {mapLambertDisk(wi, false), mapLambertDisk(wo, false)};
    const HalfGeometry g = halfGeometry(wi, wo);
    const glm::vec3 d =
        arguments == SeparableArguments::HalfCarried ? carriedDifference(g.h, wi) : differenceVector(g.h, wi);
    return {mapScaledSlope(g.h, inverseWidth, quadrant), mapLambertDisk(d, quadrant)};
}

Rgb evaluate(const FactoredBrdf& brdf, const Vec3& wiDouble, const Vec3& woDouble) {
    const glm::vec3 wi(wiDouble), wo(woDouble);
    if (wi.z <= 0 || wo.z <= 0) return Rgb(0);
    switch (brdf.form) {
        case FactoredForm::HalfDiff:
            return Rgb(halfDiff(brdf, wi, wo));
        case FactoredForm::Cosine:
            return Rgb(cosine(brdf, wi, wo));
        case FactoredForm::SingleLobe:
            return Rgb(singleLobe(brdf, wi, wo));
        case FactoredForm::Tangent:
            return Rgb(tangent(brdf, wi, wo));
        case FactoredForm::Homomorphic:
            return Rgb(homomorphic(brdf, wi, wo));
        case FactoredForm::Separable:
            return Rgb(separable(brdf, wi, wo));
    }
    return Rgb(0);
}

}  // namespace nacre
