#include "cli/eval_table.hpp"

#include <fmt/format.h>

#include <array>

#include "cli/numbers.hpp"
#include "cli/terminal.hpp"
#include "core/error.hpp"
#include "envmaps/fresnel_table.hpp"
#include "envmaps/scale_bias.hpp"

namespace nacre::cli {

static constexpr const char *kFresnel = "fresnel", *kScaleBias = "scale_bias";

bool isTable(const Asset& asset) { return asset.kind == kFresnel || asset.kind == kScaleBias; }

static void requireMapping(const AssetTexture& texture, const std::string& mapping, const std::string& file) {
    if (texture.mapping != mapping)
        throw Error(
            fmt::format("{}: part {}: expected mapping {}, found {}", file, texture.name, mapping, texture.mapping));
}

void evalTable(const Asset& asset, const std::string& file) {
    const bool fresnel = asset.kind == kFresnel;
    const AssetTexture& table = asset.texture(asset.kind);
    requireMapping(table, fresnel ? "sqrt_cos" : "cos_perceptual", file);
    std::size_t lineNumber = 0;
    forEachInputLine([&](std::string_view line) {
        ++lineNumber;
        line = trimmed(line);
        if (line.empty() || line.front() == '#' || line.substr(0, 3) == "cos") return;
        std::array<double, 2> v{};
        const std::span<double> wanted = std::span(v).first(fresnel ? 1 : 2);
        const auto inRange = [](double x) { return x >= 0 && x <= 1; };
        if (!parseNumbers(line, wanted) || !inRange(v[0]) || !inRange(v[1]))
            throw Error(fmt::format("standard input: line {}: expected {} in [0, 1], found '{}'", lineNumber,
                                    fresnel ? "one number cos" : "two numbers cos,roughness", line.substr(0, 80)));
        if (fresnel) {
            const Rgb f = lookupFresnel(table, v[0]);
            putData(fmt::format("{:.9g},{:.9g},{:.9g}\n", f.r, f.g, f.b));
        } else {
            const ScaleBias s = lookupScaleBias(table, v[0], v[1]);
            putData(fmt::format("{:.9g},{:.9g}\n", s.scale, s.bias));
        }
    });
}

}  // namespace nacre::cli
