#include "factorize/factored_brdf.hpp"

#include <fmt/format.h>

#include "core/asset.hpp"
#include "core/error.hpp"

namespace nacre {
namespace {

constexpr std::array<const char*, 6> kFormNames = {"half_diff", "cosine",      "single_lobe",
                                                   "tangent",   "homomorphic", "separable"};

/// Textures a form needs, given its constants: a file with fewer can't be evaluated.
std::size_t texturesNeeded(const FactoredBrdf& b) {
    switch (b.form) {
        case FactoredForm::HalfDiff:
            return static_cast<int>(b.params[0].y) == int(HalfDiffLayout::Compact) ? 1 : 2;
        case FactoredForm::Cosine:
            return 2;
        case FactoredForm::SingleLobe:
        case FactoredForm::Tangent:
            return 1;
        case FactoredForm::Homomorphic:
            return 1u + (b.params[0].w > 0.5f) + (b.params[1].z > 0.5f);
        case FactoredForm::Separable:
            return (static_cast<int>(b.params[0].y) == int(SeparableArguments::Symmetric) ? 1u : 2u) *
                   static_cast<std::size_t>(std::clamp(b.params[0].x, 1.0f, 2.0f));
    }
    return 1;
}

bool isLayout(float value) {
    for (const HalfDiffLayout layout :
         {HalfDiffLayout::Product, HalfDiffLayout::Harmonics, HalfDiffLayout::Compact, HalfDiffLayout::Grazing})
        if (value == static_cast<float>(layout)) return true;
    return false;
}

}  // namespace

std::string toString(FactoredForm form) { return kFormNames[static_cast<std::size_t>(form)]; }

FactoredForm factoredFormFromString(const std::string& name) {
    for (std::size_t i = 0; i < kFormNames.size(); ++i)
        if (name == kFormNames[i]) return static_cast<FactoredForm>(i);
    throw std::invalid_argument(
        fmt::format("unknown factored form '{}'; known: {}", name, fmt::join(kFormNames, ", ")));
}

std::size_t FactoredBrdf::bytes() const {
    std::size_t sum = 0;
    for (const AssetTexture& texture : textures) sum += texture.bytes();
    return sum;
}

Asset toAsset(const FactoredBrdf& brdf) {
    Asset asset;
    asset.kind = "brdf";
    asset.textures = brdf.textures;
    nlohmann::json params = nlohmann::json::array();
    for (const glm::vec4& p : brdf.params) params.push_back({p.x, p.y, p.z, p.w});
    asset.meta["form"] = toString(brdf.form);
    asset.meta["method"] = brdf.method;
    asset.meta["params"] = params;
    asset.meta["fetches"] = brdf.fetches;
    return asset;
}

FactoredBrdf factoredFromAsset(const Asset& asset, const std::string& path) {
    if (asset.kind != "brdf")
        throw Error(fmt::format("{}: expected an asset of kind brdf, found {}", path, asset.kind));
    FactoredBrdf out;
    try {
        out.form = factoredFormFromString(asset.meta.at("form").get<std::string>());
        out.method = asset.meta.at("method").get<std::string>();
        out.fetches = asset.meta.at("fetches").get<int>();
        const nlohmann::json& params = asset.meta.at("params");
        if (params.size() != kFactoredParams)
            throw Error(fmt::format("expected {} params, found {}", kFactoredParams, params.size()));
        for (int i = 0; i < kFactoredParams; ++i)
            for (int c = 0; c < 4; ++c) {
                out.params[i][c] = params[i].at(c).get<float>();
                if (!std::isfinite(out.params[i][c])) throw Error("expected finite params");
            }
    } catch (const std::exception& error) {
        throw Error(fmt::format("{}: bad brdf description: {}", path, error.what()));
    }
    if (out.form == FactoredForm::HalfDiff && !isLayout(out.params[0].y))
        throw Error(fmt::format("{}: bad brdf description: expected a half_diff layout 0 to 3, found {}", path,
                                out.params[0].y));
    out.textures = asset.textures;
    const std::size_t needed = texturesNeeded(out);
    if (out.textures.size() != needed)
        throw Error(fmt::format("{}: expected {} textures for form {}, found {}", path, needed, toString(out.form),
                                out.textures.size()));
    return out;
}

}  // namespace nacre
