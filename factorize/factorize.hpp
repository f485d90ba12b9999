// From a reflectance to its factored form: the methods by name, and the search for the cheapest one within a budget.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "factorize/factored_brdf.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

struct FactorizeOptions {
    std::string method = "auto";    ///< a name from factorizeMethods(), or auto
    int size = 0;                   ///< edge of the largest texture [texels], 2..4096; 0 = the method's own choice
    int terms = 0;                  ///< svd and fit only: SVD terms 1..2, harmonics 1..3; 0 = the method's own choice
    std::string parametrization{};  ///< svd only: half_diff (default), in_out or symmetric
    TexelFormat format = TexelFormat::Half;
    std::optional<double> maxError{};       ///< bound on `measure`
    std::optional<std::size_t> maxBytes{};  ///< of all textures
    std::optional<int> maxFetches{};
    unsigned threads = 0;
    Progress progress{};
    /// The error the budget speaks of (l2_rel against the truth). Needed when maxError is set.
    std::function<double(const FactoredBrdf&)> measure{};
};

struct FactorizeMethod {
    std::string name, summary, fits;  ///< fits: which inputs it takes, in words
};
std::vector<FactorizeMethod> factorizeMethods();

/// An option that is set but that options.method has no use for: "terms: only fit and svd take it, found method
/// analytic". Nothing for auto, which considers those methods alone.
std::optional<std::string> unusedOption(const FactorizeOptions& options);

/// \throws std::invalid_argument for unknown methods (lists the known ones), a method that doesn't fit the input or
///         leaves an option unused, sizes out of range; nacre::Error when no representation meets the budget (says how
///         near it came)
FactoredBrdf factorize(const Reflectance& reflectance, const FactorizeOptions& options);

}  // namespace nacre
