#include "cli/truth.hpp"

#include <fmt/format.h>

#include "cli/terminal.hpp"
#if __has_include("reference/analytic_brdf.hpp")
#include "reference/analytic_brdf.hpp"
#endif

namespace nacre::cli {

BrdfFunction truthOf(const Reflectance& reflectance) {
#if __has_include("reference/analytic_brdf.hpp")
    if (reflectance.kind == "analytic")
        if (std::optional<BrdfFunction> independent = referenceBrdf(reflectance.source)) return *independent;
#endif
    return reflectance.f;
}

void tellDataReport(const Reflectance& reflectance) {
    const DataReport& d = reflectance.data;
    if (d.missing + d.negative + d.nonFinite == 0) return;
    tell(fmt::format("{}: of {} entries {} are missing, {} negative, {} not finite: {}", reflectance.source, d.entries,
                     d.missing, d.negative, d.nonFinite, d.rule));
}

}  // namespace nacre::cli
