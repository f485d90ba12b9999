#include "reference/factored_metrics.hpp"

#include <memory>

#include "reference/analytic_brdf.hpp"

namespace nacre {

BrdfFunction truthOf(const Reflectance& reflectance) {
    if (reflectance.kind == "analytic")
        if (std::optional<BrdfFunction> independent = referenceBrdf(reflectance.source)) return *independent;
    return reflectance.f;
}

BrdfFunction functionOf(const FactoredBrdf& brdf) {
    return [&brdf](const Vec3& wi, const Vec3& wo) { return evaluate(brdf, wi, wo); };
}

std::function<double(const FactoredBrdf&)> budgetMeasure(const BrdfFunction& truth, const BrdfMetricOptions& options) {
    return [=, samples = std::make_shared<std::vector<TruthSample>>()](const FactoredBrdf& candidate) {
        if (samples->empty()) *samples = sampleTruth(truth, options);
        return l2Rel(functionOf(candidate), *samples, options.threads);
    };
}

}  // namespace nacre
