#include "cli/data_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/terminal.hpp"

namespace nacre::cli {

namespace {
constexpr double kPoorHoldout = 0.1;
constexpr std::uint64_t kFewSamples = 100;
}  // namespace

/// A bake is measured against the gridding, which may be far from the surface between the samples.
static void tellHoldout(const Reflectance& reflectance) {
    const DataReport& d = reflectance.data;
    if (d.distinct == 0 || (d.distinct >= kFewSamples && !(d.holdoutL2Rel > kPoorHoldout))) return;
    const std::string missed = std::isfinite(d.holdoutL2Rel)
                                   ? fmt::format("samples left out are missed by {:.2g} %", 100 * d.holdoutL2Rel)
                                   : "none could be left out to see how well they foretell each other";
    tell(
        fmt::format("{}: {} distinct samples; {}: the errors of the bake are against what was made of the samples, and "
                    "do not speak of this",
                    reflectance.source, d.distinct, missed));
}

void tellDataReport(const Reflectance& reflectance) {
    const DataReport& d = reflectance.data;
    tellHoldout(reflectance);
    if (d.missing + d.negative + d.nonFinite == 0) return;
    tell(fmt::format("{}: of {} entries {} are missing, {} negative, {} not finite: {}", reflectance.source, d.entries,
                     d.missing, d.negative, d.nonFinite, d.rule));
}

}  // namespace nacre::cli
