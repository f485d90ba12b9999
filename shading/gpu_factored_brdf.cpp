#include "shading/gpu_factored_brdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/error.hpp"

namespace nacre {

ShaderDefines factoredDefines(const FactoredBrdf& brdf) {
    std::string name = toString(brdf.form);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    return {{"NACRE_FORM", "NACRE_FORM_" + name}};
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
