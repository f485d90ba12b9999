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
/// number.
///        `sgd:NAME` is short for `sgd:material=NAME`.
/// \return source = the canonical text, with every parameter to full precision; kind "analytic"; the pieces that apply.
///         The formula of each model stands at the head of its family's .cpp (README.md lists them).
/// \throws std::invalid_argument, one line, for unknown names and parameters (lists the known ones), and for values out
///         of range (states the range)
Reflectance makeModel(const std::string& text);

}  // namespace nacre
