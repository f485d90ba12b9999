#include "demos/page.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <regex>

namespace nacre {
namespace {

using testing::HasSubstr;
using testing::Not;

Entry makeEntry(const std::string& id) {
    Entry e;
    e.id = id;
    e.section = "Section <1>";
    e.title = "Torus & <sphere>";
    e.caption = "A \"caption\".";
    e.reference = {id + "-reference.png", {1, 2, 3}};
    e.shots.push_back({"per pixel", {id + "-a.png", {4}}, {id + "-b.png", {5, 6}}, 61.25, 0.0031, 1.5});
    e.differenceScale = 0.02;
    e.geometryMilliseconds = 0.5;
    e.directMilliseconds = 4.5;
    e.directLabel = "the model";
    e.asset = {"torrance-sparrow:alpha=0.1",
               "analytic",
               "cosine",
               "2 × 64² half",
               16384,
               2,
               0.25,
               0.00123,
               0.01,
               0.2,
               0.02,
               61.0};
    e.command = "nacre factorize 'a<b>' -o torus.exr --size 64";
    return e;
}

Gallery makeGallery() {
    Gallery g;
    g.version = "1.2.3";
    g.renderer = "llvm<pipe>";
    g.machine = "2 cores";
    g.entries = {makeEntry("torus"), makeEntry("disk")};
    return g;
}

TEST(Page, HoldsEveryNumberOfAnEntry) {
    const std::string html = galleryPage(makeGallery());
    for (const char* text : {"61.2 dB", "0.310 %", "1.50 ms", "4.50 ms", "4.0×", "16.0 KiB", "0.123 %", "2 × 64² half",
                             "nacre factorize 'a&lt;b&gt;' -o torus.exr --size 64", "250 ms",
                             "speed-up: direct ÷ factored", "analytic, cosine"})
        EXPECT_THAT(html, HasSubstr(text));
    EXPECT_THAT(html, HasSubstr("<span>0</span><span>0.0050</span><span>0.010</span>"));  // the scale's ticks
    EXPECT_THAT(html, HasSubstr(".scale { background: linear-gradient(to right, rgb("));
}

TEST(Page, IntroducesEveryShortName) {
    const std::string html = galleryPage(makeGallery());
    for (const char* text :
         {"<li>HSE: ", "<li>MPR: ", "<li>PR94: ", "<li>HEMI: ", "<li>HYBRID: ", "BRDF: ", "GGX: ", "MERL: ", "CC0: "})
        EXPECT_THAT(html, HasSubstr(text));
    for (const char* text : {"mirrors and glass", "<em>hybrid</em>", "<em>transfer</em>"})
        EXPECT_THAT(html, HasSubstr(text));
}

TEST(Page, IsSelfContainedAndEscaped) {
    const std::string html = galleryPage(makeGallery());
    const std::regex reference("(?:src|href)=\"([^\"]*)\"");
    int pictures = 0;
    for (std::sregex_iterator it(html.begin(), html.end(), reference), end; it != end; ++it) {
        const std::string target = (*it)[1];
        pictures += target.rfind("data:image/png;base64,", 0) == 0;
        EXPECT_TRUE(target.rfind("data:", 0) == 0 || target.rfind("#", 0) == 0) << target.substr(0, 60);
    }
    EXPECT_EQ(pictures, 2 * 3);
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, Not(HasSubstr("url(")));
    EXPECT_THAT(html, Not(HasSubstr("<1>")));
    EXPECT_THAT(html, Not(HasSubstr("llvm<pipe>")));
    EXPECT_THAT(html, HasSubstr("href=\"#torus\""));
    EXPECT_THAT(html, HasSubstr("id=\"torus\""));
    EXPECT_THAT(html, HasSubstr("base64,AQID\""));
}

TEST(Page, SectionHeadingStandsOnceAndTheViewportIsThePhones) {
    const std::string html = galleryPage(makeGallery());
    const std::string heading = "<h2>Section &lt;1&gt;</h2>";
    const std::size_t first = html.find(heading);
    ASSERT_NE(first, std::string::npos);
    EXPECT_EQ(html.find(heading, first + 1), std::string::npos);
    EXPECT_THAT(html, HasSubstr("width=device-width"));
    EXPECT_THAT(html, HasSubstr("prefers-color-scheme: dark"));
}

TEST(Page, IdenticalPicturesAndEntriesWithoutBaseline) {
    Gallery g = makeGallery();
    g.entries[0].shots[0].psnr = 200;  // compareImages' cap
    g.entries[0].directMilliseconds.reset();
    g.entries[0].directLabel = "No direct form.";
    const std::string html = galleryPage(g);
    EXPECT_THAT(html, HasSubstr("identical"));
    EXPECT_THAT(html, HasSubstr("No direct form."));
    EXPECT_THAT(html, Not(HasSubstr("inf")));
    EXPECT_TRUE(galleryJson(g)["entries"][0]["direct_milliseconds"].is_null());
}

TEST(Page, JsonNamesFilesNotBytes) {
    const nlohmann::json json = galleryJson(makeGallery());
    EXPECT_EQ(json["entries"].size(), 2u);
    const nlohmann::json& entry = json["entries"][0];
    EXPECT_EQ(entry["reference"], "torus-reference.png");
    EXPECT_EQ(entry["shots"][0]["psnr_db"], 61.25);
    EXPECT_EQ(entry["asset"]["bytes"], 16384);
    EXPECT_EQ(entry["asset"]["error"]["l2_rel"], 0.00123);
    EXPECT_THAT(json.dump(), Not(HasSubstr("base64")));
}

TEST(Page, RejectsBrokenEntries) {
    const auto broken = [](const std::function<void(Entry&)>& change) {
        Gallery g = makeGallery();
        change(g.entries[1]);
        EXPECT_THROW(galleryPage(g), std::invalid_argument);
    };
    broken([](Entry& e) { e.id = "torus"; });
    broken([](Entry& e) { e.id = "a b"; });
    broken([](Entry& e) { e.id = ""; });
    broken([](Entry& e) { e.shots.clear(); });
    broken([](Entry& e) { e.reference.png.clear(); });
    broken([](Entry& e) { e.shots[0].psnr = std::numeric_limits<double>::quiet_NaN(); });
    broken([](Entry& e) { e.shots[0].milliseconds = std::numeric_limits<double>::infinity(); });
    broken([](Entry& e) { e.asset.error.maxRel = std::numeric_limits<double>::quiet_NaN(); });
}

TEST(Page, CostRatioLeavesTheGeometryOut) {
    EXPECT_EQ(costRatio(1.5, 4.5, 0.5), "4.0×");
    EXPECT_EQ(costRatio(2, 1.5, 1), "0.50×");
    EXPECT_EQ(costRatio(100.5, 300, 100), "–");  // lost in the geometry's noise
    EXPECT_EQ(costRatio(300, 99, 100), "–");
}

TEST(Page, Base64OfRfc4648Section10) {
    const std::string text = "foobar";
    const std::vector<std::string> expected = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    for (std::size_t n = 0; n <= text.size(); ++n) EXPECT_EQ(base64({text.begin(), text.begin() + n}), expected[n]);
}

TEST(Page, Numbers) {
    EXPECT_EQ(formatNumber(0), "0");
    EXPECT_EQ(formatNumber(0.00123), "0.00123");
    EXPECT_EQ(formatNumber(61.25, 2), "61");
    EXPECT_EQ(formatNumber(1234.5), "1234");
    EXPECT_EQ(formatNumber(0.5), "0.500");
    EXPECT_EQ(formatNumber(2e-7), "2.00e-07");
    EXPECT_EQ(formatBytes(512), "512 B");
    EXPECT_EQ(formatBytes(16384), "16.0 KiB");
    EXPECT_EQ(formatBytes(3 << 19), "1.50 MiB");
}

}  // namespace
}  // namespace nacre
