#include "envmaps/level_mapping.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/math.hpp"

namespace nacre {

static double forward(const std::string& name, double value) {
    if (name == "sqrt") return std::sqrt(value);
    return name == "log2" ? std::log2(value) : value;
}

static double backward(const std::string& name, double value) {
    if (name == "sqrt") return value * value;
    return name == "log2" ? std::exp2(value) : value;
}

void requireValid(const LevelMapping& mapping) {
    require(mapping.name == "linear" || mapping.name == "sqrt" || mapping.name == "log2",
            fmt::format("unknown level mapping '{}'; known: linear, sqrt, log2", mapping.name));
    require(!mapping.values.empty(), "level mapping: no values");
    const bool rising = mapping.values.back() >= mapping.values.front();
    for (std::size_t i = 0; i < mapping.values.size(); ++i) {
        const double v = mapping.values[i];
        require(std::isfinite(v) && std::isfinite(forward(mapping.name, v)),
                fmt::format("level mapping: {} is outside the domain of {}", v, mapping.name));
        require(i == 0 || (rising ? v > mapping.values[i - 1] : v < mapping.values[i - 1]),
                "level mapping: values must rise or fall strictly");
    }
}

double lodOf(const LevelMapping& mapping, double value) {
    const std::vector<double>& values = mapping.values;
    if (values.size() < 2) return 0;
    const double direction = values.back() > values.front() ? 1 : -1;
    for (std::size_t i = 1; i < values.size(); ++i) {
        if (direction * value >= direction * values[i] && i + 1 < values.size()) continue;
        const double low = forward(mapping.name, values[i - 1]), high = forward(mapping.name, values[i]);
        // Beyond an end, where the function may not exist, the end counts.
        const double inside =
            direction > 0 ? std::clamp(value, values[i - 1], values[i]) : std::clamp(value, values[i], values[i - 1]);
        return static_cast<double>(i - 1) + (forward(mapping.name, inside) - low) / (high - low);
    }
    return 0;
}

double valueOf(const LevelMapping& mapping, double lod) {
    const std::vector<double>& values = mapping.values;
    const double last = static_cast<double>(values.size() - 1), inside = std::clamp(lod, 0.0, last);
    const auto i = static_cast<std::size_t>(std::min(inside, std::max(0.0, last - 1)));
    if (values.size() < 2) return values.front();
    const double t = inside - static_cast<double>(i);
    return backward(mapping.name,
                    (1 - t) * forward(mapping.name, values[i]) + t * forward(mapping.name, values[i + 1]));
}

}  // namespace nacre
