#include "factorize/measured/merl.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <cstring>
#include <limits>

#include "core/error.hpp"
#include "tests/factorize/measured/measured_support.hpp"

namespace nacre {
namespace {

using namespace nacre::test;
using testing::HasSubstr;

constexpr std::array<double, 3> kScale = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr std::size_t kBytes = 12 + kMerlCells * 3 * 8;

/// A table's bytes; stored(cell) are the raw numbers of the file.
template <class Stored>
std::vector<std::uint8_t> merlBytes(const Stored& stored) {
    std::vector<std::uint8_t> bytes(kBytes);
    const std::array<std::int32_t, 3> dims = {90, 90, 180};
    std::memcpy(bytes.data(), dims.data(), 12);
    for (std::size_t i = 0; i < kMerlCells; ++i) {
        const Rgb value = stored(i);
        for (std::size_t c = 0; c < 3; ++c)
            std::memcpy(&bytes[12 + 8 * (c * kMerlCells + i)], &value[static_cast<int>(c)], 8);
    }
    return bytes;
}

HalfDifference centreOf(std::size_t cell) {
    const double h = static_cast<double>(cell / 180 / 90), d = static_cast<double>(cell / 180 % 90),
                 p = static_cast<double>(cell % 180);
    return {kPi / 2 * sqr((h + 0.5) / 90), 0, kPi / 2 * (d + 0.5) / 90, kPi * (p + 0.5) / 180};
}

bool aboveHorizon(const HalfDifference& angles) {
    const DirectionPair pair = fromHalfDifference(angles);
    return pair.wi.z > 0 && pair.wo.z > 0;
}

/// Smooth over the table's axes, 1 to 3 [1/sr], with period π in phi_d.
double smooth(const HalfDifference& a) {
    return 2 + 0.5 * std::cos(3 * std::sqrt(a.thetaH)) + 0.3 * std::cos(2 * a.thetaD) + 0.2 * std::cos(2 * a.phiD);
}
Rgb storedSmooth(std::size_t cell) {
    const HalfDifference centre = centreOf(cell);
    if (!aboveHorizon(centre)) return Rgb(-1);
    return smooth(centre) * Rgb(1 / kScale[0], 0.5 / kScale[1], 0.25 / kScale[2]);
}

/// The largest relative error of red, green and blue against `smooth` below 80 degrees.
double errorAgainstSmooth(const MerlTable& table) {
    double worst = 0;
    for (const DirectionPair& pair : samplePairs(20000, 80 * kPi / 180)) {
        const double truth = smooth(halfDifference(pair.wi, pair.wo));
        const Rgb difference = evaluate(table, pair.wi, pair.wo) / (truth * Rgb(1, 0.5, 0.25)) - 1.0;
        worst = std::max({worst, std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)});
    }
    return worst;
}

// Interpolation of cosines with half-steps of 1/180 of their range: h²/8 · f'' is 3e-4 at most, where √θh starts.
constexpr double kInterpolation = 1e-3;
// 25 % holes: a filled cell is the mean of its neighbours, at worst one-sided: h · f' is 0.5·3·√(π/2)/90/f = 2e-2.
constexpr double kFilled = 2.5e-2;

TEST(Merl, SmoothTableIsInterpolatedAndReciprocal) {
    const MerlTable table = parseMerl(merlBytes(storedSmooth), "smooth");
    EXPECT_LT(errorAgainstSmooth(table), kInterpolation);
    EXPECT_EQ(table.data.entries, 3 * kMerlCells);
    EXPECT_GT(table.data.missing, 0u);
    EXPECT_EQ(table.data.negative + table.data.nonFinite, 0u);
    for (const DirectionPair& pair : samplePairs(1000, kPi / 2)) {
        const Rgb there = evaluate(table, pair.wi, pair.wo), back = evaluate(table, pair.wo, pair.wi);
        EXPECT_NEAR(there.r, back.r, 1e-6);  // single precision
    }
}

TEST(Merl, CellCentresReturnTheFileValue) {
    const MerlTable table = parseMerl(merlBytes(storedSmooth), "smooth");
    for (std::size_t cell = 0; cell < kMerlCells; cell += 997) {
        const HalfDifference centre = centreOf(cell);
        if (!aboveHorizon(centre)) continue;
        const DirectionPair pair = fromHalfDifference(centre);
        EXPECT_NEAR(evaluate(table, pair.wi, pair.wo).g, 0.5 * smooth(centre), 1e-5) << cell;
    }
}

TEST(Merl, GrazingIsFiniteAndNearTheData) {
    const MerlTable table = parseMerl(merlBytes(storedSmooth), "smooth");
    for (double thetaDeg : {85.0, 89.0, 89.9})
        for (double phi = 0; phi < 2 * kPi; phi += 0.1)
            for (double otherDeg : {0.0, 45.0, 89.9}) {
                const Rgb f = evaluate(table, sphericalDirection(thetaDeg * kPi / 180, phi),
                                       sphericalDirection(otherDeg * kPi / 180, 0));
                EXPECT_GT(f.r, 0.9) << thetaDeg << ' ' << phi << ' ' << otherDeg;  // `smooth` spans 1 to 3
                EXPECT_LT(f.r, 3.1) << thetaDeg << ' ' << phi << ' ' << otherDeg;
            }
    EXPECT_EQ(evaluate(table, {1, 0, 0}, {0, 0, 1}), Rgb(0));
    EXPECT_EQ(evaluate(table, {0, 0, 1}, {0, 0, -1}), Rgb(0));
}

TEST(Merl, QuarterMissingNanAndNegativeEntriesAreCountedAndFilled) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::uint64_t missing = 0, negative = 0, nonFinite = 0, holes = 0;
    const auto bytes = merlBytes([&](std::size_t cell) {
        Rgb value = storedSmooth(cell);
        if (value.r < 0) return missing += 3, value;
        const auto dice = static_cast<unsigned>(100 * radicalInverse(cell * 7919 % 1000003, 2));
        if (dice >= 27) return value;
        ++holes;
        if (dice < 25) return missing += 3, Rgb(-1);
        if (dice < 26) return ++negative, value.g = -7, value;
        return nonFinite += 2, Rgb(kNan, value.g, kInfinity);
    });
    const MerlTable table = parseMerl(bytes, "holes");
    EXPECT_GT(holes, kMerlCells / 10);
    EXPECT_EQ(table.data.missing, missing);
    EXPECT_EQ(table.data.negative, negative);
    EXPECT_EQ(table.data.nonFinite, nonFinite);
    EXPECT_THAT(table.data.rule, HasSubstr(fmt::format(", {} of them above the horizon", holes)));
    EXPECT_LT(errorAgainstSmooth(table), kFilled);
}

TEST(Merl, AllBlackTableIsBlack) {
    const MerlTable table = parseMerl(merlBytes([](std::size_t) { return Rgb(0); }), "black");
    for (const DirectionPair& pair : samplePairs(1000, kPi / 2)) EXPECT_EQ(evaluate(table, pair.wi, pair.wo), Rgb(0));
}

TEST(Merl, SingleSpikeStaysInItsStencil) {
    const std::size_t spike = (20 * 90 + 30) * 180 + 179;  // its upper neighbour in phi_d is cell 0
    const MerlTable table =
        parseMerl(merlBytes([&](std::size_t cell) { return Rgb(cell == spike ? 1.5e6 : 0); }), "spike");
    const auto at = [&](double h, double d, double p) {
        const DirectionPair pair =
            fromHalfDifference({kPi / 2 * sqr((h + 0.5) / 90), 0.3, kPi / 2 * (d + 0.5) / 90, kPi * (p + 0.5) / 180});
        return evaluate(table, pair.wi, pair.wo).r;
    };
    // Averaged with its mirror image in azimuth, cell 0, which is its neighbour across the period.
    EXPECT_NEAR(at(20, 30, 179), 500, 1e-2);
    EXPECT_NEAR(at(20, 30, 0), 500, 1e-2);
    EXPECT_NEAR(at(20.25, 30, 179), 375, 1e-2);  // linear in √thetaH
    EXPECT_NEAR(at(20, 30.5, 179), 250, 1e-2);
    EXPECT_NEAR(at(20, 30, 178.25), 125, 1e-2);
    EXPECT_NEAR(at(20, 30, 179.5), 500, 1e-2);  // across the period
    EXPECT_EQ(at(21.01, 30, 179), 0);
    EXPECT_EQ(at(20, 30, 1.01), 0);
}

TEST(Merl, ResidualOfAKnownAsymmetry) {  // 3 and 1 in the halves of φd: √(2·(3−1)²/(3² + 1²)), and 2 is stored
    const auto halves = [](std::size_t cell) { return Rgb(cell % kMerlPhiD < kMerlPhiD / 2 ? 3.0 : 1.0); };
    const MerlTable table = parseMerl(merlBytes(halves), "halves");
    EXPECT_NEAR(table.mirrorResidual, std::sqrt(0.8), 1e-6);
    EXPECT_NEAR(evaluate(table, {0.6, 0, 0.8}, {0, 0.6, 0.8}).r, 2 * kScale[0], 1e-6);
}

TEST(Merl, EnergyOfConstantAndOfSpike) {
    const double stored = 0.5 / kScale[0];  // grey: 0.5 in every channel
    const MerlTable constant = parseMerl(
        merlBytes([&](std::size_t) { return stored * Rgb(1, kScale[0] / kScale[1], kScale[0] / kScale[2]); }), "grey");
    const double exact = 3 * 0.25 * sqr(kPi * sqr(std::sin(80 * kPi / 180)));  // ∫ dμ to 80° is (π sin²80°)²
    constexpr double kBlocks = 0.01;  // blocks of 1° and 2° at the 80° limit are in or out
    EXPECT_NEAR(constant.energy / exact, 1, kBlocks);

    const std::size_t spike = (20 * 90 + 30) * 180 + 60;
    const MerlTable spiked =
        parseMerl(merlBytes([&](std::size_t cell) { return Rgb(cell == spike ? 1.5e6 : 0); }), "spike");
    const double u = 20.5 / 90, h = kPi / 2 * u * u, d = kPi / 2 * 30.5 / 90, cosP = std::cos(kPi * 60.5 / 180);
    const double cosines = sqr(std::cos(h) * std::cos(d)) - sqr(std::sin(h) * std::sin(d) * cosP);
    const double cell = cosines * 4 * std::cos(d) * std::sin(h) * std::sin(d) * 2 * kPi * (kPi * u / 90) *
                        (kPi / 2 / 90) * (kPi / 180) * 2;          // both halves of φd
    const double square = sqr(500) * (1 + sqr(1.15) + sqr(1.66));  // halved with its mirror image, which has as much
    EXPECT_NEAR(spiked.energy / (2 * cell * square * 8 / 27), 1, 0.01);  // a hat's square is 2/3 of its cell, thrice
}

TEST(Merl, BadFilesAreNamedWithExpectedAndFound) {
    const auto message = [](const std::vector<std::uint8_t>& bytes) {
        const std::string text = messageOf<Error>([&] { parseMerl(bytes, "x.binary"); });
        EXPECT_EQ(text.find('\n'), std::string::npos);
        return text;
    };
    std::vector<std::uint8_t> bytes = merlBytes([](std::size_t) { return Rgb(-1); });
    EXPECT_THAT(message(bytes), HasSubstr("expected a finite value ≥ 0 above the horizon, found none"));
    bytes.push_back(0);  // oversized
    EXPECT_THAT(message(bytes),
                HasSubstr("x.binary: expected 34992012 bytes for MERL dimensions 90 90 180, found 34992013"));
    bytes.resize(1000);  // truncated
    EXPECT_THAT(message(bytes), HasSubstr("expected 34992012 bytes for MERL dimensions 90 90 180, found 1000"));
    bytes[0] = 45;
    EXPECT_THAT(message(bytes), HasSubstr("expected MERL dimensions 90 90 180, found 45 90 180"));
    bytes[3] = 0xff;  // a negative dimension
    EXPECT_THAT(message(bytes), HasSubstr("found -16777171 90 180"));
    EXPECT_THAT(message({}), HasSubstr("expected a MERL table of 34992012 bytes, found 0"));
}

TEST(Merl, OpensAFileFastAndSaysWhatItFound) {
    const TemporaryFolder folder;
    const auto bytes = merlBytes(storedSmooth);
    const auto path = folder.write("smooth.binary", bytes.data(), bytes.size());
    const auto start = std::chrono::steady_clock::now();
    const Reflectance reflectance = openMerl(path);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    RecordProperty("open_seconds", std::to_string(seconds.count()));
    EXPECT_EQ(reflectance.source, path.string());
    EXPECT_EQ(reflectance.kind, "merl");
    EXPECT_EQ(reflectance.hash.size(), 16u);
    EXPECT_TRUE(reflectance.isotropic);
    EXPECT_NEAR(reflectance.reciprocityResidual, 0, 1e-6) << "mirror-symmetric but for the float's rounding";
    EXPECT_NEAR(reflectance.f({0, 0, 1}, {0, 0, 1}).r, smooth({}), kInterpolation * 2);
    EXPECT_THAT(messageOf<Error>([&] { openMerl(path.string() + "x"); }), HasSubstr("found none"));
}

}  // namespace
}  // namespace nacre
