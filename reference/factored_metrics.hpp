// The metrics of brdf_metrics.hpp for baked BRDFs: what the command, the bench and the gallery all ask.
#pragma once

#include <functional>

#include "factorize/factored_brdf.hpp"
#include "reference/brdf_metrics.hpp"

namespace nacre {

/// What a bake is measured against: for analytic models the independent implementation of analytic_brdf.hpp, where
/// there is one; else the reflectance itself.
BrdfFunction truthOf(const Reflectance& reflectance);

/// evaluate(brdf, ·, ·). Refers to `brdf`, which must outlive it.
BrdfFunction functionOf(const FactoredBrdf& brdf);

/// FactorizeOptions::measure: E_L2 against `truth`, which is sampled at the first call and kept. A search that asks
/// with the options of the final measurement accepts what that measurement accepts.
std::function<double(const FactoredBrdf&)> budgetMeasure(const BrdfFunction& truth, const BrdfMetricOptions& options);

}  // namespace nacre
