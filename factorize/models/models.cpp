#include "factorize/models/models.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "factorize/models/model_spec.hpp"

namespace nacre {

static std::vector<ModelSpec> allModels() {
    std::vector<ModelSpec> all = phongModels();
    for (ModelSpec& spec : microfacetModels()) all.push_back(std::move(spec));
    all.push_back(wardModel());
    all.push_back(ashikhminShirleyModel());
    all.push_back(schlickModel());
    all.push_back(banksModel());
    all.push_back(sgdModel());
    return all;
}

static const std::vector<ModelSpec>& models() {
    static const std::vector<ModelSpec> all = allModels();
    return all;
}

static ModelInfo describe(const ModelSpec& spec) {
    ModelInfo info{spec.name, spec.summary, spec.source, {}};
    for (const ParameterSpec& p : spec.parameters) {
        const std::string value =
            p.standsFor.empty() ? p.defaultValue : fmt::format("(sets {})", fmt::join(p.standsFor, ", "));
        info.parameters.push_back({p.name, p.summary, rangeText(p), value});
    }
    return info;
}

const std::vector<ModelInfo>& listModels() {
    static const std::vector<ModelInfo> infos = [] {
        std::vector<ModelInfo> list;
        for (const ModelSpec& spec : models()) list.push_back(describe(spec));
        return list;
    }();
    return infos;
}

static const ModelSpec& findModel(const std::string& name) {
    std::vector<std::string> names;
    for (const ModelSpec& spec : models()) {
        if (spec.name == name) return spec;
        names.push_back(spec.name);
    }
    throw std::invalid_argument(fmt::format("unknown model '{}'; known: {}", name, fmt::join(names, ", ")));
}

Reflectance makeModel(const std::string& text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    const ModelSpec& spec = findModel(text.substr(0, colon));
    std::string parameters = colon < text.size() ? text.substr(colon + 1) : std::string();
    const bool loneWord = !parameters.empty() && parameters.find('=') == std::string::npos;
    if (loneWord && !spec.bare.empty()) parameters = spec.bare + "=" + parameters;
    const ParameterValues values = parseParameters(spec.name, parameters, spec.parameters);
    Reflectance out = spec.build(values);
    out.source = values.canonical();
    out.kind = "analytic";
    out.hash = contentHash(out.source);
    return out;
}

}  // namespace nacre
