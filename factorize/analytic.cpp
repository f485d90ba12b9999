// Methods `cosine` (HSE section 1.1 as printed) and `analytic` (the same factors, adaptive and logarithmic).
#include <fmt/format.h>

#include "core/directions.hpp"
#include "core/error.hpp"
#include "factorize/fit_samples.hpp"
#include "factorize/log_table_fit.hpp"
#include "factorize/mappings.hpp"
#include "factorize/methods.hpp"

namespace nacre {
namespace {

constexpr double kLowestCosine = 1e-3;  // elevations are never looked up closer to the horizon than this in a fill
constexpr double kDarkLog = -30;        // stands for 0 in a logarithmic table: e^-30 is below every measure

const MicrofacetPieces& isotropicPieces(const Reflectance& r, const char* method) {
    require(r.microfacet.has_value() && r.isotropic,
            fmt::format("factorize: method {} needs an isotropic microfacet model, found {}", method, r.source));
    require(r.microfacet->diffuseIsConstant && r.microfacet->visibilityIsIsotropic,
            fmt::format("factorize: method {} needs a constant diffuse term, found {}", method, r.source));
    return *r.microfacet;
}

/// Both directions in the xz plane, on opposite sides: visibility depends on elevations alone.
double visibilityAt(const MicrofacetPieces& pieces, double cosI, double cosO) {
    const auto at = [](double c, double side) { return Vec3(side * std::sqrt(std::max(0.0, 1 - c * c)), 0, c); };
    return pieces.visibility(at(std::max(cosI, kLowestCosine), 1), at(std::max(cosO, kLowestCosine), -1));
}

Rgb constantDiffuse(const MicrofacetPieces& pieces) { return pieces.diffuse(Vec3(0, 0, 1), Vec3(0, 0, 1)); }

bool isGrey(const MicrofacetPieces& pieces) {
    for (int i = 0; i <= 8; ++i) {
        const Rgb f = pieces.fresnel(i / 8.0);
        if (std::abs(f.r - f.g) + std::abs(f.r - f.b) > 1e-12 * std::abs(f.r)) return false;
    }
    return true;
}

Vec3 halfVectorOfSlope(double slope) {
    return std::isfinite(slope) ? glm::normalize(Vec3(slope, 0, 1)) : Vec3(1, 0, 0);
}

double safeLog(double value) { return value > 0 ? std::max(std::log(value), kDarkLog) : kDarkLog; }

double fraction(int i, int size) { return size > 1 ? static_cast<double>(i) / (size - 1) : 0; }

void setColorColumns(FactoredBrdf& out, bool grey) {
    for (int k = 0; k < 3; ++k) out.params[2 + k][k] = 1;
    if (grey) {
        out.params[2] = {1, 1, 1, 0};
        out.params[3] = out.params[4] = glm::vec4(0);
    }
}

/// ln(F·D) over (u, v) and ln(visibility) over (U, V): eq. 1 in logarithms.
void fillFactors(const MicrofacetPieces& pieces, double s, bool grey, FitTable& a, FitTable& b) {
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const double d = pieces.distribution(halfVectorOfSlope(inverseHalfDiffSlope(fraction(x, a.width), s)));
            const Rgb fresnel = pieces.fresnel(inverseHalfDiffCosine(fraction(y, a.height)));
            for (int c = 0; c < (grey ? 1 : 3); ++c)
                a.texels[(static_cast<std::size_t>(y) * a.width + x) * a.channels + c] =
                    static_cast<float>(safeLog(fresnel[c] * d));
        }
    for (int y = 0; y < b.height; ++y)
        for (int x = 0; x < b.width; ++x) {
            const ElevationPair e = inverseElevations(fraction(x, b.width), fraction(y, b.height));
            b.texels[static_cast<std::size_t>(y) * b.width + x] =
                static_cast<float>(safeLog(visibilityAt(pieces, e.cosMin, e.cosMax)));
        }
}

}  // namespace

AssetTexture makeScaledTexture(std::string name, std::string mapping, Image values, TexelFormat format) {
    constexpr float kComfortable = 16384;  // leaves half floats a factor of four below their largest value
    float largest = 0;
    for (float v : values.data()) largest = std::max(largest, std::abs(v));
    const float divisor = std::isfinite(largest) && largest > kComfortable ? largest / kComfortable : 1.0f;
    for (float& v : values.data()) v /= divisor;
    AssetTexture texture = makeTexture(std::move(name), std::move(mapping), values, format);
    texture.scale *= divisor;
    texture.bias *= divisor;
    return texture;
}

FactoredBrdf factorizeCosine(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options) {
    const MicrofacetPieces& pieces = isotropicPieces(r, "cosine");
    const bool grey = isGrey(pieces);
    Image a(sizes.first.x, sizes.first.y, grey ? 1 : 3), b(sizes.second.x, sizes.second.y, 1);
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const double cosDelta = fraction(y, a.height());
            const Vec3 h(std::sqrt(1 - sqr(cosDelta)), 0, cosDelta);
            const Rgb value = pieces.fresnel(fraction(x, a.width())) * pieces.distribution(h);
            for (int c = 0; c < a.channels(); ++c) a.at(x, y, c) = static_cast<float>(value[c]);
        }
    // HSE's second factor is G/(π cosβ): it holds cosα of the reflected radiance and is singular towards cosβ = 0,
    // where the first row stores the value half a texel above the horizon.
    const double edge = 0.5 / b.height();
    for (int y = 0; y < b.height(); ++y)
        for (int x = 0; x < b.width(); ++x) {
            const double cosAlpha = fraction(x, b.width()), cosBeta = std::max(fraction(y, b.height()), edge);
            b.at(x, y, 0) =
                static_cast<float>(visibilityAt(pieces, cosAlpha, cosBeta) * std::max(cosAlpha, kLowestCosine));
        }
    FactoredBrdf out;
    out.form = FactoredForm::Cosine;
    out.method = "cosine";
    out.params[1] = glm::vec4(glm::vec3(constantDiffuse(pieces)), 0);
    setColorColumns(out, grey);
    out.textures.push_back(makeScaledTexture("a", "cosine", std::move(a), options.format));
    out.textures.push_back(makeScaledTexture("b", "cosine", std::move(b), options.format));
    out.fetches = 2;
    return out;
}

FactoredBrdf factorizeAnalytic(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options) {
    const MicrofacetPieces& pieces = isotropicPieces(r, "analytic");
    const bool grey = isGrey(pieces);
    const double s = 1.5 * std::clamp(pieces.alphaX, 1e-4, 1.0);
    const Rgb diffuse = constantDiffuse(pieces);

    LogTableModel model;
    model.tables.emplace_back(
        sizes.first.x, sizes.first.y,
        grey ? std::vector<glm::vec3>{glm::vec3(1)} : std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    model.tables.emplace_back(sizes.second.x, sizes.second.y, std::vector<glm::vec3>{glm::vec3(1)});
    model.lookupCount = 2;
    model.lookups = [s](const FitSample& sample, std::span<FitLookup> lookups) {
        const HalfGeometry g = halfGeometry(glm::vec3(sample.wi), glm::vec3(sample.wo));
        lookups[0] = {0, mapHalfDiff(g, static_cast<float>(s)), glm::vec4(1)};
        lookups[1] = {1, mapElevations(static_cast<float>(sample.wi.z), static_cast<float>(sample.wo.z)), glm::vec4(1)};
    };
    fillFactors(pieces, s, grey, model.tables[0], model.tables[1]);

    report(options.progress, "refining through the filter", 0.3);
    FitSampleOptions sampling;
    sampling.count = 60000 + 24 * static_cast<std::size_t>(sizes.first.x * sizes.first.y);
    sampling.width = glm::dvec2(pieces.alphaX);
    sampling.threads = options.threads;
    sampling.maxTheta = 1.5690;  // 89.9°
    std::vector<FitSample> samples = fitSamples(r.f, sampling);
    for (FitSample& sample : samples) sample.base = glm::vec3(diffuse);
    fitLogTables(
        model, samples,
        {.newtonSteps = 4, .conjugateSteps = 25, .smoothness = 1e-4f, .anchored = true, .threads = options.threads});
    report(options.progress, "refined", 1);

    FactoredBrdf out;
    out.form = FactoredForm::HalfDiff;
    out.method = "analytic";
    out.params[0] = {static_cast<float>(s), static_cast<float>(HalfDiffLayout::Product), 0, 0};
    out.params[1] = glm::vec4(glm::vec3(diffuse), 0);
    setColorColumns(out, grey);
    out.textures.push_back(makeTexture("a", "half_diff", model.tables[0].image(), options.format));
    out.textures.push_back(makeTexture("b", "elevations", model.tables[1].image(), options.format));
    out.fetches = 2;
    return out;
}

}  // namespace nacre
