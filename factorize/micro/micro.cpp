#include "factorize/micro/micro.hpp"

#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "core/file.hpp"
#include "factorize/micro/gonioreflectometer.hpp"
#include "factorize/models/parameters.hpp"

namespace nacre {

namespace {
struct Relief {
    std::string name, summary;
    std::vector<ParameterSpec> parameters;
    HeightField (*build)(const ParameterValues&);
};
}  // namespace

static constexpr int kRidgeColumns = 96, kBumpColumns = 32;  // ridges are the same along y: one row of cells

static std::vector<ParameterSpec> withCommon(std::vector<ParameterSpec> own) {
    own.push_back(numberParameter("bounces", "light between facets after the first reflection", 0, 32, "3"));
    own.push_back(numberParameter("resolution", "directions along a side of the table", 4, 48, "24"));
    return own;
}

static std::vector<Relief> reliefs() {
    const ParameterSpec left = colourParameter("left", "albedo of faces seen from -x", 0, 1, "0.1/0.2/0.8");
    const ParameterSpec right = colourParameter("right", "albedo of faces seen from +x", 0, 1, "0.8/0.1/0.1");
    return {
        {"flat", "no relief: Lambert", withCommon({colourParameter("albedo", "of the plane", 0, 1, "0.5")}),
         [](const ParameterValues& v) { return flatField(v.colour("albedo")); }},
        {"ridges", "saw-tooth ridges along y with two colours",
         withCommon({numberParameter("slope", "of the left face", 0, 4, "1"),
                     numberParameter("peak", "share of the period taken by the left face", 0.05, 0.95, "0.5"), left,
                     right}),
         [](const ParameterValues& v) {
             return ridges({v.number("slope"), v.number("peak"), v.colour("left"), v.colour("right")}, kRidgeColumns);
         }},
        {"gaussian-bumps", "one bell-shaped bump a period, in two colours",
         withCommon({numberParameter("height", "in periods", 0, 1, "0.3"),
                     numberParameter("width", "standard deviation, in periods", 0.05, 1, "0.2"), left, right}),
         [](const ParameterValues& v) {
             return gaussianBumps({v.number("height"), v.number("width"), v.colour("left"), v.colour("right")},
                                  kBumpColumns);
         }}};
}

std::vector<ModelInfo> listMicro() {
    std::vector<ModelInfo> out;
    for (const Relief& relief : reliefs()) {
        ModelInfo info{kMicroPrefix + relief.name, relief.summary, "Westin, Arvo & Torrance 1992; HSE figure 4", {}};
        for (const ParameterSpec& p : relief.parameters)
            info.parameters.push_back({p.name, p.summary, rangeText(p), p.defaultValue});
        out.push_back(std::move(info));
    }
    return out;
}

static Relief findRelief(const std::string& name) {
    std::vector<std::string> names;
    for (const Relief& relief : reliefs()) {
        if (relief.name == name) return relief;
        names.push_back(kMicroPrefix + relief.name);
    }
    throw std::invalid_argument(
        fmt::format("unknown micro-geometry '{}{}'; known: {}", kMicroPrefix, name, fmt::join(names, ", ")));
}

static int wholeNumber(const std::string& model, const ParameterValues& values, const std::string& name) {
    const double value = values.number(name);
    require(value == std::floor(value), fmt::format("{}: {}={:g} is not a whole number", model, name, value));
    return static_cast<int>(value);
}

Reflectance openMicro(const std::string& text, unsigned threads) {
    const std::size_t start = std::string(kMicroPrefix).size();
    require(text.rfind(kMicroPrefix, 0) == 0, "openMicro: expected a text that starts with micro:");
    const std::size_t comma = std::min(text.find_first_of(",:", start), text.size());  // models have a colon there
    const Relief relief = findRelief(text.substr(start, comma - start));
    const std::string model = kMicroPrefix + relief.name;
    const std::string given = comma < text.size() ? text.substr(comma + 1) : std::string();
    const ParameterValues values = parseParameters(model, given, relief.parameters);
    const HeightField field = relief.build(values);
    const GonioreflectometerOptions options{.resolution = wholeNumber(model, values, "resolution"),
                                            .bounces = wholeNumber(model, values, "bounces"),
                                            .threads = threads};
    auto table =
        std::make_shared<const DirectionTable>(simulateReflectance(facetsOf(field), makeTracer(field), options));
    Reflectance out;
    out.source = values.canonical();
    out.source[model.size()] = ',';  // the canonical text of a model has a colon there
    out.kind = "micro";
    out.hash = contentHash(out.source);
    out.isotropic = false;
    out.data.entries = 3 * table->values.size();
    out.data.rule = "simulated: nothing is missing; the table is the mean over swapped directions";
    out.f = [table](const Vec3& wi, const Vec3& wo) { return evaluate(*table, wi, wo); };
    return out;
}

}  // namespace nacre
