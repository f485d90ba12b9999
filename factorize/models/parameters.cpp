#include "factorize/models/parameters.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "core/error.hpp"

namespace nacre {

using Given = std::map<std::string, std::string>;

ParameterSpec numberParameter(std::string name, std::string summary, double min, double max, std::string defaultValue) {
    return {std::move(name),
            std::move(summary),
            ParameterSpec::Type::Number,
            min,
            max,
            {},
            std::move(defaultValue),
            {},
            false};
}
ParameterSpec colourParameter(std::string name, std::string summary, double min, double max, std::string defaultValue) {
    return {std::move(name),
            std::move(summary),
            ParameterSpec::Type::Colour,
            min,
            max,
            {},
            std::move(defaultValue),
            {},
            false};
}
ParameterSpec choiceParameter(std::string name, std::string summary, std::vector<std::string> choices,
                              std::string defaultValue) {
    return {std::move(name),
            std::move(summary),
            ParameterSpec::Type::Choice,
            0,
            0,
            std::move(choices),
            std::move(defaultValue),
            {},
            false};
}
ParameterSpec shorthand(std::string name, std::string summary, double min, double max,
                        std::vector<std::string> standsFor, bool reciprocal) {
    return {std::move(name),      std::move(summary), ParameterSpec::Type::Number, min, max, {}, {},
            std::move(standsFor), reciprocal};
}

std::string roundTripText(double value) {
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    return std::string(buffer, result.ptr);
}

static std::string colourText(const Rgb& c) {
    if (c.r == c.g && c.g == c.b) return roundTripText(c.r);
    return roundTripText(c.r) + "/" + roundTripText(c.g) + "/" + roundTripText(c.b);
}

std::string rangeText(const ParameterSpec& spec) {
    if (spec.type == ParameterSpec::Type::Choice) return fmt::format("{}", fmt::join(spec.choices, " | "));
    const std::string range = fmt::format("[{:g}, {:g}]", spec.min, spec.max);
    return spec.type == ParameterSpec::Type::Colour ? range + " or r/g/b" : range;
}

static std::string knownNames(const std::vector<ParameterSpec>& specs) {
    if (specs.empty()) return "none";
    std::vector<std::string> names;
    for (const ParameterSpec& spec : specs) names.push_back(spec.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

static std::optional<double> parseNumber(std::string_view text) {
    double value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

/// One number, or for colours also three with slashes between.
static std::optional<Rgb> parseComponents(std::string_view text, bool colour) {
    if (const auto single = parseNumber(text)) return Rgb(*single);
    const std::size_t first = text.find('/'), last = text.rfind('/');
    if (!colour || first == last) return std::nullopt;
    const auto r = parseNumber(text.substr(0, first)), g = parseNumber(text.substr(first + 1, last - first - 1)),
               b = parseNumber(text.substr(last + 1));
    if (!r || !g || !b) return std::nullopt;
    return Rgb(*r, *g, *b);
}

static Rgb checkedNumber(const std::string& model, const ParameterSpec& spec, const std::string& text) {
    const auto value = parseComponents(text, spec.type == ParameterSpec::Type::Colour);
    bool inside = value.has_value();
    for (int c = 0; inside && c < 3; ++c) inside = (*value)[c] >= spec.min && (*value)[c] <= spec.max;  // false for NaN
    require(inside, fmt::format("{}: {}={} is not in {}", model, spec.name, text, rangeText(spec)));
    return *value + 0.0;  // -0 reads as 0, so that equal models have equal canonical texts
}

static std::string checkedChoice(const std::string& model, const ParameterSpec& spec, const std::string& text) {
    const bool known = std::find(spec.choices.begin(), spec.choices.end(), text) != spec.choices.end();
    require(known, fmt::format("{}: {}={} is unknown; known: {}", model, spec.name, text, rangeText(spec)));
    return text;
}

static Given splitPairs(const std::string& model, std::string_view text, const std::vector<ParameterSpec>& specs) {
    Given given;
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        const std::string_view pair = text.substr(0, comma);
        const std::size_t equals = pair.find('=');
        require(equals != std::string_view::npos && (comma + 1 < text.size() || comma == text.size()),
                fmt::format("{}: '{}' is no key=value pair; known parameters: {}", model, text, knownNames(specs)));
        const std::string key(pair.substr(0, equals));
        const bool known = std::any_of(specs.begin(), specs.end(), [&](const auto& spec) { return spec.name == key; });
        require(known, fmt::format("{}: unknown parameter '{}'; known: {}", model, key, knownNames(specs)));
        const bool fresh = given.emplace(key, pair.substr(equals + 1)).second;
        require(fresh, fmt::format("{}: parameter '{}' is given twice", model, key));
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return given;
}

/// Replaces shorthands by what they stand for.
static void expandShorthands(const std::string& model, const std::vector<ParameterSpec>& specs, Given& given) {
    for (const ParameterSpec& spec : specs) {
        if (spec.standsFor.empty() || !given.count(spec.name)) continue;
        const double value = checkedNumber(model, spec, given[spec.name]).x;
        for (const std::string& target : spec.standsFor) {
            const bool fresh = given.emplace(target, roundTripText(spec.reciprocal ? 1.0 / value : value)).second;
            require(fresh, fmt::format("{}: give either '{}' or '{}', not both", model, spec.name, target));
        }
    }
}

ParameterValues parseParameters(const std::string& model, std::string_view text,
                                const std::vector<ParameterSpec>& specs) {
    Given given = splitPairs(model, text, specs);
    expandShorthands(model, specs, given);
    ParameterValues values;
    values.canonical_ = model;
    char separator = ':';
    for (const ParameterSpec& spec : specs) {
        if (!spec.standsFor.empty()) continue;
        const auto it = given.find(spec.name);
        const std::string& typed = it != given.end() ? it->second : spec.defaultValue;
        std::string shown;
        if (spec.type == ParameterSpec::Type::Choice) {
            shown = values.choices_[spec.name] = checkedChoice(model, spec, typed);
        } else {
            shown = colourText(values.numbers_[spec.name] = checkedNumber(model, spec, typed));
        }
        values.canonical_ += separator + spec.name + "=" + shown;
        separator = ',';
    }
    return values;
}

}  // namespace nacre
