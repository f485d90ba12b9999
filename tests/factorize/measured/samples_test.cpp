#include "factorize/measured/samples.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "core/error.hpp"
#include "tests/factorize/measured/measured_support.hpp"

namespace nacre {
namespace {

using namespace nacre::test;
using testing::HasSubstr;

/// Diffuse and a broad highlight with some retro-reflection: isotropic, reciprocal.
Rgb smooth(const Vec3& wi, const Vec3& wo) {
    const HalfDifference a = halfDifference(wi, wo);
    return Rgb(0.3, 0.1, 0.02) / kPi + 0.8 * std::exp(-8 * a.thetaH * a.thetaH) * (1 + a.thetaD) +
           0.1 * sqr(std::sin(a.thetaH) * std::sin(a.thetaD) * std::cos(a.phiD));
}

std::string vectorsCsv(const std::vector<DirectionPair>& pairs) {
    std::string text = "# made by a test\nwix,wiy,wiz,wox,woy,woz,r,g,b\n";
    for (const DirectionPair& p : pairs) {
        const Rgb f = smooth(p.wi, p.wo);
        text +=
            fmt::format("{},{},{},{},{},{},{},{},{}\n", p.wi.x, p.wi.y, p.wi.z, p.wo.x, p.wo.y, p.wo.z, f.r, f.g, f.b);
    }
    return text;
}

/// Root mean square of ln((found + ε)/(expected + ε)), ε = 1e-3: FACTORIZATION.md's E_log without its measure.
double logError(const BrdfFunction& found, const std::vector<BrdfSample>& expected) {
    double sum = 0;
    for (const BrdfSample& s : expected) {
        const Rgb ratio = glm::log((found(s.pair.wi, s.pair.wo) + 1e-3) / (s.f + 1e-3));
        sum += dot(ratio, ratio) / 3;
    }
    return std::sqrt(sum / static_cast<double>(expected.size()));
}

TEST(Samples, SmoothFunctionIsRecoveredBetweenItsSamples) {
    const TemporaryFolder folder;
    const std::vector<DirectionPair> all = samplePairs(6000, 80 * kPi / 180);
    const std::vector<DirectionPair> given(all.begin(), all.begin() + 5000);
    const Reflectance r = openReflectance(folder.write("s.csv", vectorsCsv(given)));
    EXPECT_EQ(r.kind, "samples");
    EXPECT_TRUE(r.isotropic);
    EXPECT_EQ(r.data.entries, 5000u);
    EXPECT_THAT(r.data.rule, HasSubstr("the 5000 others are gridded"));
    std::vector<BrdfSample> heldOut;
    for (std::size_t i = 5000; i < all.size(); ++i) heldOut.push_back({all[i], smooth(all[i].wi, all[i].wo)});
    EXPECT_LT(logError(r.f, heldOut), 0.02);  // measured 0.012
    for (const DirectionPair& pair : samplePairs(1000, 89.9 * kPi / 180)) {
        const Rgb there = r.f(pair.wi, pair.wo), back = r.f(pair.wo, pair.wi);
        ASSERT_TRUE(isFinite(there) && std::min({there.r, there.g, there.b}) >= 0);
        EXPECT_LT(glm::length(there - back), 1e-6 * glm::length(there));
        const Rgb mirrored = r.f(Vec3(pair.wi.x, -pair.wi.y, pair.wi.z), Vec3(pair.wo.x, -pair.wo.y, pair.wo.z));
        EXPECT_LT(glm::length(there - mirrored), 1e-6 * glm::length(there));
        EXPECT_LT(there.r, 3);
    }
    EXPECT_EQ(r.f({1, 0, 0}, {0, 0, 1}), Rgb(0));
}

/// A lobe on a diffuse ground at `count` pairs.
std::vector<BrdfSample> lobeSamples(std::uint64_t count) {
    std::vector<BrdfSample> out;
    for (std::uint64_t i = 1; i <= count; ++i) {
        const Vec3 wi = cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)});
        const Vec3 wo = cosineHemisphere({radicalInverse(i, 5), radicalInverse(i, 7)});
        out.push_back({{wi, wo}, Rgb(0.05 + 0.5 * std::pow(glm::normalize(wi + wo).z, 40))});
    }
    return out;
}

TEST(Samples, HoldoutTellsFewSamplesFromMany) {
    DataReport few, many, one, black;
    holdOut(lobeSamples(10), few);
    holdOut(lobeSamples(3000), many);
    EXPECT_EQ(few.distinct, 10u);
    EXPECT_GT(few.holdoutL2Rel, 0.2);
    EXPECT_EQ(many.distinct, 3000u);
    EXPECT_LT(many.holdoutL2Rel, 0.1);
    std::vector<BrdfSample> same(50, lobeSamples(1)[0]), dark = lobeSamples(20);
    holdOut(same, one);
    EXPECT_EQ(one.distinct, 1u) << "copies foretell nothing";
    EXPECT_TRUE(std::isnan(one.holdoutL2Rel));
    for (BrdfSample& s : dark) s.f = Rgb(0);
    holdOut(dark, black);
    EXPECT_LT(black.holdoutL2Rel, 1e-9);
}

TEST(Samples, ConstantBlackAndSingleSamplesAreExact) {
    const auto grid = [](const std::string& lines) {
        return gridSamples(parseSamples("wix,wiy,wiz,wox,woy,woz,r,g,b\n" + lines, "x").samples);
    };
    const SampleGrid one = grid("0,0,1,0,0,1,0.5,0.25,0\n");
    EXPECT_NEAR(evaluate(one, {0, 0.6, 0.8}, {0, 0, 1}).r, 0.5, 1e-6);
    EXPECT_NEAR(evaluate(one, {0, 0.6, 0.8}, {0, 0, 1}).b, 0, 1e-9);
    const SampleGrid black = grid("0,0,1,0,0,1,0,0,0\n0,0.6,0.8,0,0,1,0,0,0\n");
    EXPECT_LT(maxComponent(evaluate(black, {0, 0, 1}, {0.6, 0, 0.8})), 1e-9);
    std::string twins;
    for (int i = 0; i < 100; ++i) twins += "0,0,1,0,0,1,0.5,0.5,0.5\n";
    EXPECT_NEAR(evaluate(grid(twins), {0, 0.6, 0.8}, {0, 0, 1}).g, 0.5, 1e-6);
    EXPECT_THROW(gridSamples({}), std::invalid_argument);
}

TEST(Samples, SameBitsForAnyThreadCount) {
    const std::vector<BrdfSample> samples = parseSamples(vectorsCsv(samplePairs(200, 1.4)), "x").samples;
    EXPECT_EQ(gridSamples(samples, 1).logs, gridSamples(samples, 7).logs);
}

TEST(Samples, AnglesInRadiansAndDegreesMeanTheSame) {
    const auto first = [](const std::string& text) { return parseSamples(text, "x").samples.at(0); };
    const BrdfSample degrees =
        first("theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg, r, g, b\r\n60, 90, 30, 0, 1, +2, 3e0\r\n");
    const BrdfSample radians =
        first("theta_i,phi_i,theta_o,phi_o,r,g,b\n1.0471975511965976,1.5707963267948966,0.5235987755982988,0,1,2,3");
    const BrdfSample vectors =
        first("wix,wiy,wiz,wox,woy,woz,r,g,b\n0,0.8660254037844386,0.5,0.5,0,0.8660254037844387,1,2,3\n\n");
    for (const BrdfSample& s : {radians, vectors}) {
        EXPECT_LT(glm::length(s.pair.wi - degrees.pair.wi) + glm::length(s.pair.wo - degrees.pair.wo), 1e-12);
        EXPECT_EQ(s.f, Rgb(1, 2, 3));
    }
}

TEST(Samples, NegativeNonFiniteAndHorizonLinesAreCountedAndLeftOut) {
    const ParsedSamples parsed = parseSamples(
        "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,r,g,b\n"
        "0,0,0,0,1,1,1\n0,0,0,0,1,-1,1\n0,0,0,0,nan,1,1\n0,0,0,0,1,1,inf\n0,0,0,0,1e999,1,1\n90,0,0,0,1,1,1\n",
        "x");
    EXPECT_EQ(parsed.samples.size(), 1u);
    EXPECT_EQ(parsed.data.entries, 6u);
    EXPECT_EQ(parsed.data.negative, 1u);
    EXPECT_EQ(parsed.data.nonFinite, 3u);
    EXPECT_EQ(parsed.data.missing, 1u);
}

TEST(Samples, BadFilesAreNamedWithLineExpectedAndFound) {
    const auto message = [](const std::string& text) {
        const std::string out = messageOf<Error>([&] { parseSamples(text, "x.csv"); });
        EXPECT_EQ(out.find('\n'), std::string::npos);
        EXPECT_EQ(out.rfind("x.csv: ", 0), 0u) << out;
        return out;
    };
    const std::string header = "wix,wiy,wiz,wox,woy,woz,r,g,b\n", good = "0,0,1,0,0,1,1,1,1\n";
    EXPECT_THAT(message(""), HasSubstr("expected a header line wix,wiy,wiz,wox,woy,woz,r,g,b, found none"));
    EXPECT_THAT(message("\n# nothing\n"), HasSubstr("found none"));
    EXPECT_THAT(message("a,b\n"), HasSubstr("line 1: expected a header wix,wiy"));
    EXPECT_THAT(message("\x01\xff" + std::string(500, 'a')), HasSubstr("found '??aaa"));
    EXPECT_THAT(message(header), HasSubstr("found none usable in 0 lines"));
    EXPECT_THAT(message(header + "0,0,1,0,0,1,nan,1,1\n"),
                HasSubstr("found none usable in 1 lines (0 negative, 1 not"));
    EXPECT_THAT(message(header + good + "0,0,1,0,0,1,1,1\n"), HasSubstr("line 3: expected 9 numbers, found 8"));
    EXPECT_THAT(message(header + good + "0,0,1,0,0,1,1,1,\n"), HasSubstr("line 3: expected a number, found ''"));
    EXPECT_THAT(message(header + good + "0,0,1,0,0,1,1,1,2x\n"), HasSubstr("line 3: expected a number, found '2x'"));
    EXPECT_THAT(message(header + "0,0,2,0,0,1,1,1,1\n"), HasSubstr("line 2: expected unit directions, found one of"));
    EXPECT_THAT(message(header + "nan,0,1,0,0,1,1,1,1\n"), HasSubstr("line 2: expected unit directions"));
    EXPECT_THAT(message(header + "0,0,1,0,0,-1,1,1,1\n"),
                HasSubstr("expected directions above the horizon, found z = -1"));
    const std::string angles = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
    EXPECT_THAT(message(angles + "-0.1,0,0,0,1,1,1\n"), HasSubstr("line 2: expected elevations >= 0, found -0.1"));
    EXPECT_THAT(message(angles + "2,0,0,0,1,1,1\n"), HasSubstr("line 2: expected directions above the horizon"));
}

/// Three of the 31 bands of Cornell's gonioreflectometer file, as CSV.
std::string cornellCsv(const std::filesystem::path& path, std::vector<BrdfSample>& heldOut) {
    std::ifstream in(path);
    std::string out = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
    int count = 0;
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        std::vector<double> n;
        for (double value; fields >> value;) n.push_back(value);
        if (n.size() != 35) continue;  // four angles and 400 to 700 nm by 10
        const Rgb f(n[4 + 21], n[4 + 15], n[4 + 5]);
        if (++count % 10 == 0)
            heldOut.push_back({{sphericalDirection(n[0], n[1]), sphericalDirection(n[2], n[3])}, f});
        else
            out += fmt::format("{},{},{},{},{},{},{}\n", n[0], n[1], n[2], n[3], f.r, f.g, f.b);
    }
    return out;
}

TEST(SamplesRealFile, CornellBluePaintIsPredictedWhereHeldOut) {
    const auto path = sharedFile("brdf/cornell_krylon_blue.brdf");
    if (path.empty()) GTEST_SKIP() << "no ../shared/data/brdf (or NACRE_SHARED)";
    std::vector<BrdfSample> heldOut;
    const TemporaryFolder folder;
    const Reflectance paint = openSamples(folder.write("krylon.csv", cornellCsv(path, heldOut)));
    EXPECT_GT(paint.data.entries, 1000u);
    // Beyond 60° red and green are near 0 and differ up to tenfold when the directions are swapped: no target.
    std::erase_if(heldOut, [](const BrdfSample& s) { return std::min(s.pair.wi.z, s.pair.wo.z) < 0.5; });
    EXPECT_GT(heldOut.size(), 40u);
    EXPECT_LT(logError(paint.f, heldOut), 0.1);  // measured 0.06
    const Rgb body = paint.f(sphericalDirection(0.8, 0), sphericalDirection(0.5, 1.5));
    EXPECT_GT(body.b, 3 * body.r);  // it is blue
}

}  // namespace
}  // namespace nacre
