// The textual form of a model, `name:key=value,key=value`: declaring parameters once, for parsing, for range checks,
// for the list that people read, and for the canonical text.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.hpp"
#include "factorize/models/models.hpp"

namespace nacre {

/// One parameter a model takes.
struct ParameterSpec {
    enum class Type { Number, Colour, Choice };
    std::string name, summary;
    Type type = Type::Number;
    double min = 0, max = 1;           ///< Number, Colour (each component): inclusive range
    std::vector<std::string> choices;  ///< Choice
    std::string defaultValue;          ///< as typed; empty for a shorthand
    /// A shorthand stands for other parameters (`alpha` for alphax and alphay); giving both is an error. It has no
    /// place in the canonical text.
    std::vector<std::string> standsFor;
    bool reciprocal = false;  ///< the shorthand sets 1/value (Banks' r for the exponent n)
};

ParameterSpec numberParameter(std::string name, std::string summary, double min, double max, std::string defaultValue);
ParameterSpec colourParameter(std::string name, std::string summary, double min, double max, std::string defaultValue);
ParameterSpec choiceParameter(std::string name, std::string summary, std::vector<std::string> choices,
                              std::string defaultValue);
ParameterSpec shorthand(std::string name, std::string summary, double min, double max,
                        std::vector<std::string> standsFor, bool reciprocal = false);

/// What the user may type, for lists and messages: "[0.001, 1]", "beckmann | ggx | gaussian".
std::string rangeText(const ParameterSpec& spec);

/// Every parameter of a model with a checked value.
class ParameterValues {
public:
    double number(const std::string& name) const { return numbers_.at(name).x; }
    Rgb colour(const std::string& name) const { return numbers_.at(name); }
    const std::string& choice(const std::string& name) const { return choices_.at(name); }
    /// `name:key=value,…` with every parameter in declared order and full round-trip precision.
    const std::string& canonical() const { return canonical_; }

private:
    friend ParameterValues parseParameters(const std::string&, std::string_view, const std::vector<ParameterSpec>&);
    std::map<std::string, Rgb> numbers_;
    std::map<std::string, std::string> choices_;
    std::string canonical_;
};

/// \param model  the model's name, for messages;  \param text  what follows the colon, may be empty
/// \throws std::invalid_argument, one line: unknown key (lists the known ones), key given twice, value that does not
///         parse or is out of range (states the range)
ParameterValues parseParameters(const std::string& model, std::string_view text,
                                const std::vector<ParameterSpec>& specs);

/// Shortest text that reads back as the same double.
std::string roundTripText(double value);

}  // namespace nacre
