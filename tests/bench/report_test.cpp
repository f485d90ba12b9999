#include "bench/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "bench/plot.hpp"

using namespace nacre;
using namespace nacre::bench;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Measurement measurement(const std::string& material, const Setting& setting, double l2, std::size_t bytes) {
    Measurement m;
    m.material = {material, Group::Isotropic, material};
    m.setting = setting;
    m.error.l2Rel = l2;
    m.error.spherePsnr = 50;
    m.bytes = bytes;
    m.cost = FrameCost{1, 4, "model"};
    return m;
}

}  // namespace

TEST(BenchReport, SummariesAreMediansAndRangesOfAGroup) {
    const Setting fit{"fit", 32};
    std::vector<Measurement> all = {measurement("a", fit, 0.1, 100), measurement("b", fit, 0.4, 100),
                                    measurement("c", fit, 0.2, 100)};
    all.push_back(measurement("elsewhere", fit, 9, 100));
    all.back().material.group = Group::RglFiles;
    const auto summaries = summarise(all, Group::Isotropic);
    ASSERT_EQ(summaries.size(), 1u);
    EXPECT_EQ(summaries[0].materials, 3u);
    EXPECT_DOUBLE_EQ(summaries[0].l2, 0.2);
    EXPECT_DOUBLE_EQ(summaries[0].l2Low, 0.1);
    EXPECT_DOUBLE_EQ(summaries[0].l2High, 0.4);
    EXPECT_DOUBLE_EQ(summaries[0].costRatio, 0.25);
}

TEST(BenchReport, AKnobThatAMethodLacksGivesOneSummary) {
    const auto summaries =
        summarise({measurement("a", {"fit", 64}, 0.1, 100), measurement("a", {"fit", 64, 2}, 0.1, 100),
                   measurement("a", {"fit", 64, 3}, 0.05, 150)},
                  Group::Isotropic);
    ASSERT_EQ(summaries.size(), 2u);
    EXPECT_EQ(summaries[1].setting.terms, 3);
}

TEST(BenchReport, JsonHoldsEveryMeasurementAndNamesInfinities) {
    Report report;
    report.measurements = {measurement("a", {"fit", 32}, kInfinity, 100)};
    report.bars = {{"what", "l2_rel", 0.1, 0.2, false, "a", true}};
    const auto json = nlohmann::json::parse(reportJson(report).dump());
    EXPECT_EQ(json["measurements"][0]["error"]["l2_rel"], "inf");
    EXPECT_EQ(json["measurements"][0]["cost"]["ratio"], 0.25);
    EXPECT_EQ(json["bars"][0]["pass"], false);
}

TEST(BenchReport, PageShowsGroupsThatHaveMeasurementsAndEscapesNames) {
    Report report;
    report.renderer = "driver <1>";
    report.measurements = {measurement("a & b", {"fit", 32}, 0.01, 100)};
    const std::string page = reportPage(report);
    EXPECT_THAT(page, HasSubstr("a &amp; b"));
    EXPECT_THAT(page, HasSubstr("driver &lt;1&gt;"));
    EXPECT_THAT(page, HasSubstr("Error against cost"));
    EXPECT_THAT(page, HasSubstr(title(Group::Isotropic)));
    EXPECT_THAT(page, Not(HasSubstr("<h2>" + title(Group::RglFiles))));
    report.renderer.clear();
    EXPECT_THAT(reportPage(report), Not(HasSubstr("Error against cost")));
}

TEST(BenchBars, PassDependsOnTheDirectionOfTheLimit) {
    EXPECT_TRUE((Bar{"", "", 0.1, 0.1, false, "", true}.pass()));
    EXPECT_FALSE((Bar{"", "", 0.1, 0.11, false, "", true}.pass()));
    EXPECT_FALSE((Bar{"", "", 60, 59.9, true, "", true}.pass()));
    EXPECT_TRUE((Bar{"", "", 60, 61, true, "", true}.pass()));
    EXPECT_FALSE((Bar{"", "", 0.1, 0, false, "", false}.pass()));  // nothing measured
    EXPECT_FALSE((Bar{"", "", 0.1, std::numeric_limits<double>::quiet_NaN(), false, "", true}.pass()));
    const std::string table =
        barTable({{"what", "l2_rel", 0.1, 0.2, false, "a", true}, {"x", "y", 1, 0, false, "", false}});
    EXPECT_THAT(table, HasSubstr("MISS  what"));
    EXPECT_THAT(table, HasSubstr("n/a   x"));
}

TEST(BenchBars, MedianOfEvenAndOddCounts) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
    EXPECT_EQ(median({kInfinity, 1, kInfinity}), kInfinity);
    EXPECT_THROW(median({}), std::invalid_argument);
}

TEST(BenchPlot, PointsWithoutAPlaceAreSaid) {
    Plot plot;
    plot.title = "T";
    plot.series = {{"fit",
                    {{100, 0.1, 0.05, 0.2, "one <&>", true},
                     {200, 0, 0, 0, "zero", false},
                     {300, kInfinity, 0, 0, "inf", false}}}};
    const std::string svg = svgPlot(plot);
    EXPECT_THAT(svg, HasSubstr("T (2 without a place on it)"));
    EXPECT_THAT(svg, HasSubstr("one &lt;&amp;>"));
    EXPECT_THAT(svg, HasSubstr("class=\"ring\""));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr(">inf<")));
}

TEST(BenchPlot, NoPointsGiveAnEmptyPlot) {
    const std::string svg = svgPlot({});
    EXPECT_THAT(svg, HasSubstr("<svg"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(BenchSweep, SettingsAreWordsThatTellThemApart) {
    EXPECT_EQ(text({.method = "fit",
                    .size = 64,
                    .terms = 2,
                    .format = TexelFormat::Unorm8,
                    .maxBytes = 1000,
                    .maxFetches = 2}),
              "fit 64, 2 terms, unorm8, at most 1000 bytes, at most 2 fetches");
    EXPECT_EQ(text(Setting{}), "auto");
}
