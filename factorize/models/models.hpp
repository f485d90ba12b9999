// Analytic reflectance models by textual name: `torrance-sparrow:d=beckmann,alpha=0.1,f=conductor,eta=1.5,k=3`.
#pragma once

#include <string>
#include <vector>

#include "factorize/reflectance.hpp"

namespace nacre {

struct ModelParameter {
    std::string name, summary;
    std::string range;         ///< for people: "(0, 1]", "beckmann | ggx | gaussian"
    std::string defaultValue;  ///< as it would be typed
};

struct ModelInfo {
    std::string name, summary, source;  ///< source: the paper
    std::vector<ModelParameter> parameters;
};

/// Every model makeModel knows, in the order they are shown.
const std::vector<ModelInfo>& listModels();

/// \param text  name, then optionally ':' and comma-separated key=value; colours are r/g/b ("0.9/0.6/0.2") or one
/// number \throws std::invalid_argument for unknown names, parameters, or values out of range; the message lists the
/// known ones
Reflectance makeModel(const std::string& text);

}  // namespace nacre
