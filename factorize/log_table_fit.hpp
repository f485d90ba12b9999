// Fits textures whose values add up to the logarithm of a BRDF, through the bilinear filter that will read them:
//   f̂(s) = base(s) + exp(offset(s) + Σ_lookups Σ_ch weight_ch · texture(uv)_ch · color_ch)
// or, for separable forms, whose values multiply in pairs, Σ_pairs Σ_ch a_ch · b_ch · color_ch, with exp or without.
// Gauss–Newton with conjugate gradients on loss = 0.3 · E_log² + E_L2² (both defined in reference/README.md). The study
// behind the choice of loss and domain is summed up in factorize/README.md.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "core/image.hpp"
#include "core/math.hpp"

namespace nacre {

/// A texture to be fitted. Texel (0,0) is uv (0,0), the last one uv (1,1).
struct FitTable {
    int width = 0, height = 0, channels = 0;
    std::array<glm::vec3, 4> color{};  ///< channel c adds sample · color[c] to the logarithm of RGB
    std::vector<float> texels;         ///< width × height × channels

    FitTable() = default;
    FitTable(int w, int h, std::vector<glm::vec3> channelColors);
    /// Resampled bilinearly; used from coarse to fine.
    void resize(int w, int h);
    Image image() const;
};

struct FitLookup {
    int table = 0;
    glm::vec2 uv{0};
    glm::vec4 weight{1};  ///< of each channel: powers of a coordinate, or 0
};

/// One direction pair with the BRDF's value there.
struct FitSample {
    Vec3 wi, wo;
    float measure = 0;    ///< cosθi cosθo dωi dωo of the sample, up to a common factor
    glm::vec3 value{0};   ///< f [1/sr], finite, ≥ 0
    glm::vec3 base{0};    ///< the part of f̂ outside the exponential, ≥ 0
    glm::vec3 offset{0};  ///< a known part of the logarithm
};

struct LogTableModel {
    std::vector<FitTable> tables;
    int lookupCount = 1;
    bool products = false;    ///< lookups 2j and 2j+1 multiply, channel by channel, coloured as the first; weights 1
    bool exponential = true;  ///< false: f̂ = base + offset + sum, which may come out below 0; the loss leads it back
    /// Writes lookupCount lookups for a sample. Thread-safe.
    std::function<void(const FitSample&, std::span<FitLookup>)> lookups;
};

struct FitOptions {
    int newtonSteps = 6;
    int conjugateSteps = 30;
    float smoothness = 1e-4f;  ///< weight of squared texel differences, relative to the mean diagonal
    bool anchored = false;     ///< tables start filled: smooth the correction to them, not the tables
    unsigned threads = 0;
};

/// Improves model.tables in place; never makes the loss larger. Same bits for any thread count.
/// \return the loss reached
double fitLogTables(LogTableModel& model, std::span<const FitSample> samples, const FitOptions& options);

}  // namespace nacre
