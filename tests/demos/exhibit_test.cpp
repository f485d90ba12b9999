#include <set>
// Exhibits on the page, the orientation chart, and the surroundings.
#include "demos/exhibit.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/error.hpp"
#include "demos/exhibit_list.hpp"
#include "demos/orientation_chart.hpp"
#include "demos/page.hpp"
#include "demos/shadow_verdict.hpp"
#include "demos/surrounding.hpp"
#include "envmaps/convert.hpp"

namespace nacre {
namespace {

using testing::HasSubstr;
using testing::Not;

Exhibit someExhibit() {
    Exhibit e;
    e.id = "env-a";
    e.section = "Section <2>";
    e.title = "Rows & panels";
    e.caption = "A \"caption\".";
    e.rows.push_back({"first <row>", {{"as it is", {"a.png", {1}}, {}, {}}}});
    e.rows.push_back({"second",
                      {{"n = 1.5", {"b.png", {2}}, Comparison{{"c.png", {3}}, {"d.png", {4}}, 43.25, 0.0123}, 1.25},
                       {"n = 5", {"e.png", {5}}, Comparison{{"f.png", {6}}, {"g.png", {7}}, 51, 0.5}, 2.5}}});
    e.differenceScale = 0.02;
    e.geometryMilliseconds = 0.5;
    e.scene = "sphere";
    e.commands = {"nacre envmap 'a b.exr' -o c.exr"};
    return e;
}

TEST(Exhibit, PageAndJsonHoldEveryNumber) {
    Gallery gallery;
    gallery.exhibits = {someExhibit()};
    const std::string html = galleryPage(gallery);
    for (const char* text :
         {"first &lt;row&gt;", "n = 1.5; 1.25 ms", "43.2 dB", "1.23 %", "n = 5; 2.50 ms", "51.0 dB", "0.500 ms",
          "href=\"#env-a\"", "id=\"env-a\"", "<span>0</span><span>0.0050</span><span>0.010</span>"})
        EXPECT_THAT(html, HasSubstr(text));
    EXPECT_THAT(html, HasSubstr("nacre envmap 'a b.exr' -o c.exr"));
    EXPECT_THAT(html, Not(HasSubstr("<row>")));
    const nlohmann::json json = galleryJson(gallery).at("exhibits").at(0);
    EXPECT_EQ(json.at("rows").at(1).at("panels").at(0).at("psnr_db"), 43.25);
    EXPECT_FALSE(json.at("rows").at(0).at("panels").at(0).contains("psnr_db"));
    EXPECT_EQ(lowestPsnr(someExhibit()), 43.25);
    Exhibit compared = someExhibit();
    compared.rows.push_back(compared.rows[1]);
    compared.rows.back().panels[0].comparison->psnr = 10;
    compared.rows.back().ours = false;
    compared.rows.back().panels[0].milliseconds = 99;
    EXPECT_EQ(lowestPsnr(compared), 43.25);
    EXPECT_EQ(longestFrame(compared), 2.5);
    EXPECT_THAT(exhibitHtml(compared), HasSubstr("second; <span class=\"soft\">for comparison</span></h4>"));
    compared.rows.back().ours = true;
    EXPECT_EQ(lowestPsnr(compared), 10);
    compared.rows.back().panels[0].ours = false;
    EXPECT_EQ(lowestPsnr(compared), 43.25);
    EXPECT_EQ(longestFrame(compared), 2.5);
    EXPECT_THAT(exhibitHtml(compared), HasSubstr("n = 1.5; 99.0 ms; for comparison"));
    EXPECT_FALSE(exhibitJson(compared)["rows"][2]["panels"][0]["ours"]);
    EXPECT_EQ(longestFrame(someExhibit()), 2.5);
    EXPECT_EQ(picturesOf(someExhibit()).size(), 7u);
}

TEST(Exhibit, ColumnsSayHowManyFiguresStandLevelAndBarsWhatTheyEndAt) {
    const std::string html = exhibitHtml(someExhibit());
    for (const char* text :
         {"<div class=\"pair\" style=\"--figures: 1\">", "<div class=\"pair\" style=\"--figures: 3\">",
          "of shown values, 0 to 1; the brightest colour is 0.020 and more"})
        EXPECT_THAT(html, HasSubstr(text));
}

TEST(Exhibit, ATableIsOnThePageAndInTheJson) {
    Exhibit e = someExhibit();
    EXPECT_THAT(exhibitHtml(e), Not(HasSubstr("<table")));
    EXPECT_FALSE(exhibitJson(e).contains("table"));
    e.table = {{"depth", "leaks"}, {{"16 < 24", "0.1 %"}, {"24 bits", "0.01 %"}}};
    for (const char* text : {"<th scope=\"col\">leaks</th>", "<td>16 &lt; 24</td>", "<span>0.01 %</span>"})
        EXPECT_THAT(exhibitHtml(e), HasSubstr(text));
    EXPECT_EQ(exhibitJson(e).at("table").at("rows").at(1).at(1), "0.01 %");
}

TEST(VerdictPicture, EachKindHasItsColourOverTheTruthInGrey) {
    Image truth(2, 2, 1), verdict(2, 2, 1);
    truth.at(0, 0, 0) = 1;
    verdict.at(1, 0, 0) = 1, verdict.at(0, 1, 0) = 2, verdict.at(1, 1, 0) = 3;
    const Image out = verdictPicture(truth, verdict, 2);
    const Rgb grey = out.rgb(0, 0), acne = out.rgb(1, 0), leak = out.rgb(0, 1), boundary = out.rgb(1, 1);
    EXPECT_TRUE(grey.r == grey.g && grey.g == grey.b && grey.r < 2);
    EXPECT_TRUE(acne.r == 2 && acne.g < 0.2 && acne.b < 0.2);
    EXPECT_TRUE(leak.b == 2 && leak.r < 0.2 && leak.g < 0.5);
    EXPECT_TRUE(boundary.r == 2 && boundary.g > 1 && boundary.b == 0);
    EXPECT_LT(verdictPicture(Image(1, 1, 1), Image(1, 1, 1), 2).rgb(0, 0).r, grey.r);  // shadow is darker
    EXPECT_THROW(verdictPicture(truth, Image(1, 2, 1), 1), std::invalid_argument);
}

TEST(Exhibit, RefusesWhatThePageCannotShow) {
    const auto refused = [](auto breakIt) {
        Exhibit e = someExhibit();
        breakIt(e);
        EXPECT_THROW(exhibitHtml(e), std::invalid_argument);
    };
    refused([](Exhibit& e) { e.id = "A b"; });
    refused([](Exhibit& e) { e.rows.clear(); });
    refused([](Exhibit& e) { e.rows[0].panels[0].picture.png.clear(); });
    refused([](Exhibit& e) { e.rows[1].panels[0].comparison->difference.file.clear(); });
    refused([](Exhibit& e) { e.rows[1].panels[0].comparison->psnr = std::numeric_limits<double>::quiet_NaN(); });
    refused([](Exhibit& e) { e.table = {{"a", "b"}, {{"1"}}}; });
    refused([](Exhibit& e) { e.table = {{}, {{}}}; });
    Gallery twice;
    twice.exhibits = {someExhibit(), someExhibit()};
    EXPECT_THROW(galleryPage(twice), std::invalid_argument);
}

TEST(OrientationChart, EachAxisHasItsColourInEveryLayout) {
    const std::pair<Vec3, Rgb> expected[] = {{{1, 0, 0}, {1, 0, 0}},  {{-1, 0, 0}, {0, 1, 1}}, {{0, 1, 0}, {0, 1, 0}},
                                             {{0, -1, 0}, {1, 0, 1}}, {{0, 0, 1}, {0, 0, 1}},  {{0, 0, -1}, {1, 1, 0}}};
    for (const EnvLayout layout :
         {EnvLayout::LatLong, EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::Octahedral}) {
        const EnvMap map = orientationChartMap(layout, 96);
        for (const auto& [axis, color] : expected) {
            const Vec3 d = glm::normalize(axis + Vec3(0.8, 0.7, 0.75) * (Vec3(1) - glm::abs(axis)));  // beside the name
            const Rgb found = sampleEnv(map, d);
            for (int c = 0; c < 3; ++c) EXPECT_EQ(found[c] > 0.35, color[c] > 0.5) << toString(layout) << c << axis.x;
        }
    }
}

// A dot of a letter: + and - differ only above and below the bar, and +X's bar has no dots where -X has none.
TEST(OrientationChart, SignsDiffer) {
    EXPECT_EQ(orientationChart(glm::normalize(Vec3(1, 0.13, -0.43))),
              Rgb(1));  // +X: the plus's upright, left of the middle
    EXPECT_NE(orientationChart(glm::normalize(Vec3(-1, 0.13, 0.43))), Rgb(1));  // -X has none there
}

TEST(Surrounding, AMadeUpSkyStandsInAndSaysSo) {
    const Surrounding s = openSurrounding("city", "/nonexistent-nacre-folder");
    EXPECT_THAT(s.note, HasSubstr("city.exr"));
    EXPECT_TRUE(s.file.empty());
    const EnvMap small = syntheticSky(64);
    const Rgb energy = envEnergy(small);
    EXPECT_GT(energy.b, 1);
    double brightest = 0;
    const EnvMap sky = syntheticSky(256);
    for (const float v : sky.image.data()) brightest = std::max<double>(brightest, v);
    EXPECT_GT(brightest, 5000 * energy.b / (4 * kPi));  // a sun
    EXPECT_GT(sampleEnv(small, {0, 1, 0}).b, sampleEnv(small, {0, -1, 0}).b);
}

TEST(ExhibitList, IdsAreUnique) {
    const std::vector<std::string> ids = exhibitIds();
    EXPECT_GE(ids.size(), 8u);
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
}

}  // namespace
}  // namespace nacre
