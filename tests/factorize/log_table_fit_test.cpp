#include "factorize/log_table_fit.hpp"

#include <gtest/gtest.h>

#include "core/sampling.hpp"

namespace nacre {
namespace {

/// Samples of f = exp(y(u, v)), u and v hidden in wi.
template <class F>
std::vector<FitSample> samplesOf(F y, int count) {
    std::vector<FitSample> out(count);
    for (int i = 0; i < count; ++i) {
        const double u = radicalInverse(i, 2), v = radicalInverse(i, 3);
        out[i].wi = {u, v, 0};
        out[i].measure = 1;
        out[i].value = glm::vec3(static_cast<float>(std::exp(y(u, v))));
    }
    return out;
}

LogTableModel oneTable(int size) {
    LogTableModel model;
    model.tables.emplace_back(size, size, std::vector<glm::vec3>{glm::vec3(1)});
    model.lookups = [](const FitSample& s, std::span<FitLookup> out) { out[0] = {0, glm::vec2(s.wi), glm::vec4(1)}; };
    return model;
}

TEST(LogTableFit, FindsABilinearLogarithm) {
    const auto y = [](double u, double v) { return 1 - 3 * u + v - 2 * u * v; };
    LogTableModel model = oneTable(5);
    const double loss = fitLogTables(model, samplesOf(y, 4000), {.newtonSteps = 20, .smoothness = 1e-7f});
    EXPECT_LT(loss, 1e-8);
    for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i) EXPECT_NEAR(model.tables[0].texels[j * 5 + i], y(i / 4.0, j / 4.0), 2e-3);
}

TEST(LogTableFit, BeatsTexelsTakenFromTheFunction) {
    const auto y = [](double u, double v) { return -8 * u * u + std::sin(4 * v); };
    const std::vector<FitSample> samples = samplesOf(y, 20000);
    LogTableModel filled = oneTable(9), fitted = oneTable(9);
    for (int j = 0; j < 9; ++j)
        for (int i = 0; i < 9; ++i) filled.tables[0].texels[j * 9 + i] = static_cast<float>(y(i / 8.0, j / 8.0));
    fitted.tables = filled.tables;
    const double before = fitLogTables(filled, samples, {.newtonSteps = 0});
    const double after = fitLogTables(fitted, samples, {.newtonSteps = 6, .smoothness = 1e-6f, .anchored = true});
    EXPECT_LT(after, 0.5 * before);  // least squares over linear pieces: a factor of 6 in theory
}

TEST(LogTableFit, SameBitsForAnyThreadCount) {
    const std::vector<FitSample> samples = samplesOf([](double u, double v) { return u - v * v; }, 3000);
    LogTableModel one = oneTable(8), many = oneTable(8);
    fitLogTables(one, samples, {.newtonSteps = 3, .threads = 1});
    fitLogTables(many, samples, {.newtonSteps = 3, .threads = 7});
    EXPECT_EQ(one.tables[0].texels, many.tables[0].texels);
}

TEST(LogTableFit, UnseenTexelsStayBoundedAndBlackStaysFinite) {
    std::vector<FitSample> corner = samplesOf([](double, double) { return 2.0; }, 500);
    for (FitSample& s : corner) s.wi *= 0.2;  // only the first texels are ever looked at
    LogTableModel model = oneTable(16);
    fitLogTables(model, corner, {.newtonSteps = 8});
    for (float t : model.tables[0].texels) EXPECT_LT(std::abs(t), 4);

    std::vector<FitSample> black = corner;
    for (FitSample& s : black) s.value = glm::vec3(0);
    LogTableModel dark = oneTable(16);
    EXPECT_TRUE(std::isfinite(fitLogTables(dark, black, {.newtonSteps = 8})));
    for (float t : dark.tables[0].texels) EXPECT_TRUE(std::isfinite(t));
}

/// Lookups 0 and 1 over u and v multiply.
LogTableModel twoFactors(bool exponential, float start) {
    LogTableModel model;
    for (int k = 0; k < 2; ++k) model.tables.emplace_back(5, 1, std::vector<glm::vec3>{glm::vec3(1)});
    for (FitTable& table : model.tables) std::fill(table.texels.begin(), table.texels.end(), start);
    model.lookupCount = 2;
    model.products = true;
    model.exponential = exponential;
    model.lookups = [](const FitSample& s, std::span<FitLookup> out) {
        out[0] = {0, glm::vec2(s.wi.x, 0), glm::vec4(1)};
        out[1] = {1, glm::vec2(s.wi.y, 0), glm::vec4(1)};
    };
    return model;
}

TEST(LogTableFit, FindsAProduct) {  // of two linear functions, which the filter holds exactly
    const auto product = [](double u, double v) { return (1 + u) * (2 - v); };
    for (const bool exponential : {false, true}) {
        const auto y = [&](double u, double v) {
            return exponential ? product(u, v) : std::log(product(u, v));  // samplesOf takes the logarithm of f
        };
        LogTableModel model = twoFactors(exponential, 1);
        const double loss = fitLogTables(model, samplesOf(y, 4000), {.newtonSteps = 30, .smoothness = 1e-7f});
        EXPECT_LT(loss, 1e-8) << exponential;
        const float scale = model.tables[0].texels[0];
        for (int i = 0; i < 5; ++i) EXPECT_NEAR(model.tables[0].texels[i] / scale, 1 + i / 4.0, 2e-3) << exponential;
    }
}

TEST(LogTableFit, ValuesBelowZeroComeBack) {  // where the logarithm ends, its tangent still pulls
    LogTableModel model = oneTable(3);
    model.exponential = false;
    std::fill(model.tables[0].texels.begin(), model.tables[0].texels.end(), -0.01f);
    fitLogTables(model, samplesOf([](double, double) { return -2.0; }, 500), {.newtonSteps = 30});
    for (float t : model.tables[0].texels) EXPECT_NEAR(t, std::exp(-2.0), 2e-3);
}

TEST(LogTableFit, RejectsNoSamples) {
    LogTableModel model = oneTable(4);
    EXPECT_THROW(fitLogTables(model, {}, {}), std::invalid_argument);
}

TEST(FitTable, ResizeKeepsALinearRamp) {
    FitTable table(3, 2, {glm::vec3(1), glm::vec3(0, 1, 0)});
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) {
            table.texels[(y * 3 + x) * 2] = static_cast<float>(x);
            table.texels[(y * 3 + x) * 2 + 1] = static_cast<float>(y);
        }
    table.resize(5, 4);
    EXPECT_NEAR(table.texels[(0 * 5 + 4) * 2], 2, 1e-6);
    EXPECT_NEAR(table.texels[(0 * 5 + 1) * 2], 0.5, 1e-6);
    EXPECT_NEAR(table.texels[(3 * 5 + 0) * 2 + 1], 1, 1e-6);
}

}  // namespace
}  // namespace nacre
