// Analytic models evaluated in the shader: what factored BRDFs are measured against in run-time cost (and, being the
// same formulas in single precision, a check of the GLSL).
#pragma once

#include <array>
#include <optional>

#include "factorize/reflectance.hpp"
#include "shading/program.hpp"

namespace nacre {

inline constexpr int kDirectParams = 16;

/// Constants and #defines for shaders/nacre/bind/direct_brdf.glsl; holds no OpenGL object.
class GpuDirectBrdf {
public:
    GpuDirectBrdf(ShaderDefines defines, const std::array<glm::vec4, kDirectParams>& params)
        : defines_(std::move(defines)), params_(params) {}

    const ShaderDefines& defines() const { return defines_; }
    /// Sets nacre_direct_params; leaves `program` in use.
    void bind(const Program& program) const { program.set("nacre_direct_params", params_); }

private:
    ShaderDefines defines_;
    std::array<glm::vec4, kDirectParams> params_;
};

/// The shader form of a model made by makeModel, read from its canonical text.
/// \return nothing when the reflectance is no model, or one without a shader form
std::optional<GpuDirectBrdf> directBrdf(const Reflectance& reflectance);

}  // namespace nacre
