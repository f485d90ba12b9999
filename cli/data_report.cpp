#include "cli/data_report.hpp"

#include <fmt/format.h>

#include "cli/terminal.hpp"

namespace nacre::cli {

void tellDataReport(const Reflectance& reflectance) {
    const DataReport& d = reflectance.data;
    if (d.missing + d.negative + d.nonFinite == 0) return;
    tell(fmt::format("{}: of {} entries {} are missing, {} negative, {} not finite: {}", reflectance.source, d.entries,
                     d.missing, d.negative, d.nonFinite, d.rule));
}

}  // namespace nacre::cli
