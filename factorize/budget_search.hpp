// The search for the cheapest representation within bounds, which knows methods only by what they cost.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "factorize/factorize.hpp"

namespace nacre {

struct BudgetCandidate {
    std::string ladder;     ///< candidates of one name differ in size alone
    std::size_t bytes = 0;  ///< > 0, lower bound; for one ladder in the same proportion to what a bake has
    int fetches = 0;        ///< lower bound
    bool usual = false;     ///< no larger than what the method takes unasked: quick enough to say how near it comes
    std::function<FactoredBrdf()> bake;
};

/// With options.maxError: from small to large, the first that meets it by options.measure; sizes at which even the
/// fastest fall of the error would miss are passed over. A ladder whose error falls too slowly is probed at its largest
/// candidate and given up when that one misses too; one that is far off is given up at once, and its largest usual one
/// baked only to be named: an impossible bound costs two to four bakes a ladder. Without: the largest within bytes and
/// fetches. Nothing is baked when the lower bounds rule out everything. \throws nacre::Error naming `source`, the
/// bounds, and how near it came
FactoredBrdf searchBudget(const std::string& source, std::vector<BudgetCandidate> candidates,
                          const FactorizeOptions& options);

}  // namespace nacre
