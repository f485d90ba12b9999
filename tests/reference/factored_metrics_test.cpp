#include "reference/factored_metrics.hpp"

#include <gtest/gtest.h>

#include "factorize/factorize.hpp"

namespace nacre {
namespace {

TEST(FactoredMetrics, BudgetMeasureIsTheFinalMeasurement) {
    const Reflectance model = openReflectance("blinn-phong:kd=0.2,n=20");
    const FactoredBrdf baked = factorize(model, {.size = 32});
    const BrdfMetricOptions options{.samples = 20000};
    const auto measure = budgetMeasure(model.f, options);
    for (int again = 0; again < 2; ++again)
        EXPECT_EQ(measure(baked), measureBrdf(functionOf(baked), model.f, options).l2Rel);
}

TEST(FactoredMetrics, TruthIsTheIndependentModelWhereThereIsOne) {
    const Vec3 wi = glm::normalize(Vec3(0.5, 0.1, 0.6)), wo = glm::normalize(Vec3(-0.4, 0.2, 0.7));
    Reflectance model = openReflectance("torrance-sparrow:alpha=0.3");
    model.f = [](const Vec3&, const Vec3&) { return Rgb(-1); };
    EXPECT_GT(truthOf(model)(wi, wo).r, 0) << "its own f was not asked";
    model.kind = "merl";
    EXPECT_EQ(truthOf(model)(wi, wo).r, -1);
}

}  // namespace
}  // namespace nacre
