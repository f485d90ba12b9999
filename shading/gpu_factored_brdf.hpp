// A factored BRDF on the GPU: its textures, and the uniforms that shaders/nacre/bind/factored_brdf.glsl declares.
#pragma once

#include <vector>

#include "factorize/factored_brdf.hpp"
#include "shading/program.hpp"
#include "shading/texture.hpp"

namespace nacre {

/// The #defines a program needs to evaluate `brdf`: NACRE_FORM, the form's name as in bind/factored_brdf.glsl, and
/// NACRE_SPECIALIZE, the constants that choose a variant as literals (a fifth to a third of the frame time on llvmpipe
/// against choosing at run time). BRDFs of one form and variant share a program.
ShaderDefines factoredDefines(const FactoredBrdf& brdf);

class GpuFactoredBrdf {
public:
    /// \throws std::invalid_argument with more than kMaxFactoredTextures textures
    explicit GpuFactoredBrdf(const FactoredBrdf& brdf);

    /// What a program must be loaded with.
    const ShaderDefines& defines() const { return defines_; }
    /// Binds the textures to units firstUnit, firstUnit + 1, … and sets nacre_brdf_tex0..3, _params, _scale, _bias.
    /// Samplers without a texture of their own share the first one's unit: GLSL ES refuses unbound samplers in use.
    /// Leaves `program` in use.
    void bind(const Program& program, int firstUnit = 0) const;

private:
    ShaderDefines defines_;
    std::vector<Texture> textures_;
    std::array<glm::vec4, kFactoredParams> params_{};
    std::array<glm::vec4, kMaxFactoredTextures> scale_{}, bias_{};
};

}  // namespace nacre
