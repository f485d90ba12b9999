// Runs a GLSL function of two directions on many pairs at once: every GPU-against-C++ test goes through here.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/directions.hpp"
#include "shading/context.hpp"
#include "shading/program.hpp"

namespace nacre::test {

/// One context for the test program. Fails (throws nacre::Error) where none can be made: a GPU test never skips.
const Context& context(GlApi api = GlApi::Core33);

struct GpuFunction {
    std::string code;  ///< GLSL that ends up defining vec4 evaluate(vec3 wi, vec3 wo); may #include
    ShaderDefines defines{};
    std::function<void(const Program&)> bind{};  ///< sets uniforms and textures (units 2 and up); may be empty
    Glsl dialect = Glsl::V330;
};

/// evaluate(wi, wo) of each pair, in order. Directions go in and values come out as 32-bit floats.
std::vector<glm::vec4> gpuEvaluate(const GpuFunction& function, std::span<const DirectionPair> pairs);

/// `count` pairs over both hemispheres (cosine-weighted, Halton) and, after them, the hard ones: each of 0, 45, 80, 89
/// and 89.9 degrees with each, at azimuths 0, 90, 180 and 237 degrees apart, mirror and retro-reflection among them.
std::vector<DirectionPair> testPairs(std::size_t count);

}  // namespace nacre::test
