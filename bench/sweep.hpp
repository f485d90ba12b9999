// One bake and what was measured of it; and the settings that are tried.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/materials.hpp"
#include "factorize/factorize.hpp"
#include "reference/brdf_metrics.hpp"

namespace nacre::bench {

/// What the user would type.
using Setting = FactorizeOptions;
std::string text(const Setting& setting);

/// Every method with its knobs, for any input: a method refuses inputs it doesn't fit.
/// `auto` is left to the bars, which bake it within their budgets. \param quick  few sizes
std::vector<Setting> sweepSettings(bool quick, bool isotropic);

/// HSE section 1.1 as published: two textures, linear in the cosines, in the fixed-point format of its hardware.
bool isPapersSetting(const Setting& setting);

/// Frame times of one picture with the factored BRDF, and with the model evaluated in the same shader.
struct FrameCost {
    double factoredMs = 0, directMs = 0;
    std::string direct;  ///< what was evaluated directly
    double ratio() const { return factoredMs / directMs; }
};

struct Measurement {
    Material material;
    Setting setting;
    std::string form, method;  ///< as the baker answered
    std::string textures;      ///< "64x64x3 half, …"
    int fetches = 0, channels = 0;
    std::size_t bytes = 0;
    double seconds = 0;  ///< to bake, without opening the source
    double reciprocityResidual = 0;
    BrdfError error;
    std::optional<FrameCost> cost;
};

/// A bake with its error. Nothing when the method doesn't fit the input or the setting.
/// \throws nacre::Error when no representation meets a budget
struct Baked {
    FactoredBrdf brdf;
    Measurement measurement;
};
std::optional<Baked> bake(const Material& material, const OpenMaterial& opened, const Setting& setting,
                          std::uint64_t samples);

}  // namespace nacre::bench
