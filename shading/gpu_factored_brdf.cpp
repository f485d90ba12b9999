#include "shading/gpu_factored_brdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/error.hpp"

namespace nacre {

namespace {

struct Place {
    int index, component;
};

/// Constants that choose a variant of a form: whole numbers.
std::vector<Place> selectors(FactoredForm form) {
    switch (form) {
        case FactoredForm::HalfDiff:
            return {{0, 1}};  // layout
        case FactoredForm::SingleLobe:
            return {{0, 1}, {0, 2}};  // argument, unit axis
        case FactoredForm::Homomorphic:
            return {{0, 2}, {0, 3}, {1, 2}, {2, 3}};  // quadrant, textures, Smith
        case FactoredForm::Separable:
            return {{0, 0}, {0, 1}, {0, 2}, {0, 3}};  // terms, arguments, storage, quadrant
        case FactoredForm::Cosine:
        case FactoredForm::Tangent:
            break;
    }
    return {};
}

/// Constants that drop a logarithm when they are 0.
std::vector<Place> powers(FactoredForm form) {
    if (form == FactoredForm::Homomorphic) return {{1, 0}, {1, 1}, {1, 3}};
    return {};
}

std::string literal(const Place& at, float value) {
    return fmt::format("p[{}].{} = {:.1f}; ", at.index, "xyzw"[at.component], value);
}

}  // namespace

ShaderDefines factoredDefines(const FactoredBrdf& brdf) {
    std::string name = toString(brdf.form);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    ShaderDefines out{{"NACRE_FORM", "NACRE_FORM_" + name}};
    const auto valueAt = [&brdf](const Place& at) { return brdf.params[at.index][at.component]; };
    std::string literals;
    for (const Place& at : selectors(brdf.form))
        if (valueAt(at) == std::round(valueAt(at))) literals += literal(at, valueAt(at));
    for (const Place& at : powers(brdf.form))
        if (valueAt(at) == 0) literals += literal(at, 0);
    if (!literals.empty()) out.emplace_back("NACRE_SPECIALIZE", literals);
    return out;
}

GpuFactoredBrdf::GpuFactoredBrdf(const FactoredBrdf& brdf) : defines_(factoredDefines(brdf)), params_(brdf.params) {
    require(brdf.textures.size() <= kMaxFactoredTextures,
            fmt::format("GpuFactoredBrdf: at most {} textures, found {}", kMaxFactoredTextures, brdf.textures.size()));
    scale_.fill(glm::vec4(1));
    bias_.fill(glm::vec4(0));
    for (std::size_t i = 0; i < brdf.textures.size(); ++i) {
        textures_.emplace_back(brdf.textures[i]);
        scale_[i] = brdf.textures[i].scale;
        bias_[i] = brdf.textures[i].bias;
    }
}

void GpuFactoredBrdf::bind(const Program& program, int firstUnit) const {
    for (int i = 0; i < kMaxFactoredTextures; ++i) {
        const bool present = i < static_cast<int>(textures_.size());
        if (present) textures_[static_cast<std::size_t>(i)].bind(firstUnit + i);
        program.set(fmt::format("nacre_brdf_tex{}", i), present ? firstUnit + i : firstUnit);
    }
    program.set("nacre_brdf_params", params_);
    program.set("nacre_brdf_scale", scale_);
    program.set("nacre_brdf_bias", bias_);
}

}  // namespace nacre
