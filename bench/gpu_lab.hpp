// What needs OpenGL: frame times, and the shader's values against the C++ twin's.
#pragma once

#include <string>
#include <vector>

#include "bench/sweep.hpp"
#include "core/directions.hpp"
#include "shading/context.hpp"
#include "shading/lit_pass.hpp"
#include "shading/program.hpp"

namespace nacre::bench {

class GpuLab {
public:
    /// \param repeats  of each frame; the median counts.  \throws nacre::Error without a usable OpenGL
    explicit GpuLab(int repeats);

    std::string description() const { return context_.description(); }
    /// In words, for the page.
    static std::string frameText();

    /// One frame with `brdf` against one with the model evaluated in the same shader, interleaved. Reflectances
    /// without a shader form are compared with Torrance-Sparrow (Beckmann, Smith, dielectric).
    FrameCost cost(const FactoredBrdf& brdf, const Reflectance& reflectance);

    /// max |GLSL − C++| / (C++ + 1e-5 of the largest value) over `pairs` and channels; infinite where GLSL isn't
    /// finite.
    double glslDeviation(const FactoredBrdf& brdf, const std::vector<DirectionPair>& pairs);

private:
    Context context_;
    ProgramLoader loader_;
    RenderTarget target_;
    GpuMesh mesh_;
    LitView view_;
    int repeats_;
};

/// Pairs over both hemispheres, a fifth of them within 2° of the horizon.
std::vector<DirectionPair> deviationPairs(std::size_t count);

}  // namespace nacre::bench
