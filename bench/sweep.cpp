#include "bench/sweep.hpp"

#include <fmt/format.h>

#include <chrono>

#include "reference/factored_metrics.hpp"

namespace nacre::bench {

std::string text(const Setting& s) {
    std::string out = s.method;
    if (s.size > 0) out += fmt::format(" {}", s.size);
    if (!s.parametrization.empty()) out += " " + s.parametrization;
    if (s.terms > 0) out += fmt::format(", {} terms", s.terms);
    if (s.format != TexelFormat::Half) out += ", " + toString(s.format);
    if (s.maxError) out += fmt::format(", error at most {}", *s.maxError);
    if (s.maxBytes) out += fmt::format(", at most {} bytes", *s.maxBytes);
    if (s.maxFetches) out += fmt::format(", at most {} fetches", *s.maxFetches);
    return out;
}

/// A method's edges worth a point on a plot, the usual one first; a quick run takes that alone.
static std::vector<int> sizesOf(const std::string& method) {
    if (method == "single-lobe") return {256, 64, 1024};
    if (method == "tangent") return {128, 32, 64, 256};
    if (method == "svd") return {32, 16, 48};
    if (method == "fit") return {64, 16, 24, 32, 48, 96};
    return {64, 16, 32, 128};
}

/// The dear fits at one size; the bars add what `auto` chooses.
static void addQuick(const std::string& method, bool isotropic, std::vector<Setting>& out) {
    if (method == "homomorphic" && isotropic) return;
    if (method == "fit") return out.push_back({method, 32, 1});
    out.push_back({method, sizesOf(method).front()});
    if (method == "analytic") out.push_back({method, 32});
    if (method == "cosine") out.push_back({.method = method, .size = 64, .format = TexelFormat::Unorm8});
}

static void addAll(const std::string& method, std::vector<Setting>& out) {
    const bool hasTerms = method == "fit" || method == "svd";
    const std::vector<int> sizes = sizesOf(method);
    for (const int size : sizes)
        for (int terms = 0; terms <= (hasTerms ? 2 : 0); ++terms) out.push_back({method, size, terms});
    for (const TexelFormat format : {TexelFormat::Unorm8, TexelFormat::Float})
        for (const int size : {sizes[0], sizes[2]}) out.push_back({.method = method, .size = size, .format = format});
    if (method == "svd") out.push_back({.method = "svd", .size = 32, .parametrization = "in_out"});
}

std::vector<Setting> sweepSettings(bool quick, bool isotropic) {
    std::vector<Setting> out;
    for (const FactorizeMethod& method : factorizeMethods())
        quick ? addQuick(method.name, isotropic, out) : addAll(method.name, out);
    return out;
}

bool isPapersSetting(const Setting& s) { return s.method == "cosine" && s.format == TexelFormat::Unorm8; }

static std::string texturesText(const FactoredBrdf& brdf) {
    std::string out;
    for (const AssetTexture& t : brdf.textures)
        out += fmt::format("{}{}x{}x{} {}", out.empty() ? "" : ", ", t.image.width(), t.image.height(),
                           t.image.channels(), toString(t.format));
    return out;
}

static FactorizeOptions withMeasure(const OpenMaterial& opened, Setting setting) {
    setting.measure =
        budgetMeasure(opened.truth, {.samples = kSearchSamples, .isotropic = opened.reflectance.isotropic});
    return setting;
}

std::optional<Baked> bake(const Material& material, const OpenMaterial& opened, const Setting& setting,
                          std::uint64_t samples) {
    Baked out;
    const auto start = std::chrono::steady_clock::now();
    try {
        out.brdf = factorize(opened.reflectance, withMeasure(opened, setting));
    } catch (const std::invalid_argument&) {  // the documented answer of a method that doesn't fit
        return std::nullopt;
    }
    Measurement& m = out.measurement;
    m.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    m.material = material;
    m.setting = setting;
    m.form = toString(out.brdf.form);
    m.method = out.brdf.method;
    m.textures = texturesText(out.brdf);
    m.fetches = out.brdf.fetches;
    m.bytes = out.brdf.bytes();
    m.reciprocityResidual = opened.reflectance.reciprocityResidual;
    for (const AssetTexture& t : out.brdf.textures) m.channels = std::max(m.channels, t.image.channels());
    m.error = measureBrdf(
        functionOf(out.brdf), opened.truth,
        {.samples = samples, .isotropic = opened.reflectance.isotropic, .truthEnergy = opened.reflectance.energy});
    return out;
}

}  // namespace nacre::bench
