#include "factorize/measured/rgl.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "core/error.hpp"
#include "core/file.hpp"
#include "factorize/measured/reciprocity.hpp"
#include "factorize/measured/tensor_file.hpp"
#include "tests/factorize/measured/measured_support.hpp"

namespace nacre {
namespace {

using namespace nacre::test;
using testing::HasSubstr;

/// Writes a tensor file.
class TensorWriter {
public:
    template <class T>
    void add(const std::string& name, std::uint8_t type, const std::vector<std::uint64_t>& shape,
             const std::vector<T>& values) {
        number<std::uint16_t>(name.size());
        directory_ += name;
        number<std::uint16_t>(shape.size());
        number<std::uint8_t>(type);
        offsets_.push_back({directory_.size(), data_.size()});
        number<std::uint64_t>(0);
        for (const std::uint64_t size : shape) number<std::uint64_t>(size);
        data_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    std::vector<std::uint8_t> bytes() const {
        std::string out("tensor_file\0\1\0", 14);
        const auto count = static_cast<std::uint32_t>(offsets_.size());
        out.append(reinterpret_cast<const char*>(&count), 4);
        const std::size_t start = out.size();
        out += directory_ + data_;
        for (const auto& [at, offset] : offsets_) {
            const std::uint64_t absolute = start + directory_.size() + offset;
            std::memcpy(&out[start + at], &absolute, 8);
        }
        return {out.begin(), out.end()};
    }

private:
    template <class T, class V>
    void number(V value) {
        const T typed = static_cast<T>(value);
        directory_.append(reinterpret_cast<const char*>(&typed), sizeof typed);
    }
    std::string directory_, data_;
    std::vector<std::pair<std::size_t, std::size_t>> offsets_;
};

constexpr int kSize = 5;  // edge of the test files' grids

/// ndf = 1 + x, sigma = 0.5 + y... with x = √(2θ/π), y = azimuth; vndf = (1 + x)(1 + 2y); rgb = affine in the warped
/// point and in phi_i, theta_i: everything is inside the interpolants' reach, so that f is known in closed form.
struct Affine {
    std::vector<float> phiI{0}, thetaI{0, 0.5f, 1.6f};

    Rgb value(double phi, double theta, const Vec2& v) const {
        return Rgb(1 + v.x, 2 - v.y, 0.5 + 0.1 * theta) + 0.2 * (phi - phiI.front());
    }
    Rgb f(double phiSlice, double phiM, const Vec3& wi, const Vec3& wo) const {
        const Vec3 m = halfVector(wi, wo);
        const double x = std::sqrt(angleBetween(m, {0, 0, 1}) * 2 / kPi), y = (phiM + kPi) / (2 * kPi);
        const double thetaWi = angleBetween(wi, {0, 0, 1});
        const Vec2 v((x + x * x / 2) / 1.5, (y + y * y) / 2);
        return value(phiSlice, thetaWi, v) * (1 + x) / (4 * (0.5 + std::sqrt(thetaWi * 2 / kPi)) * wo.z);
    }
    std::vector<std::uint8_t> bytes(float spoil = 0) const {
        std::vector<float> ndf, sigma, vndf, rgb;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const float px = static_cast<float>(x) / (kSize - 1);
                ndf.push_back(1 + px);
                sigma.push_back(0.5f + px);
            }
        for (const float phi : phiI)
            for (const float theta : thetaI) {
                for (int i = 0; i < kSize * kSize; ++i)
                    vndf.push_back(static_cast<float>((1 + (i % kSize) / 4.0) * (1 + 2 * (i / kSize) / 4.0)));
                for (int c = 0; c < 3; ++c)
                    for (int i = 0; i < kSize * kSize; ++i)
                        rgb.push_back(
                            static_cast<float>(value(phi, theta, {(i % kSize) / 4.0, std::floor(i / kSize) / 4.0})[c]));
            }
        if (spoil != 0) rgb[7] = spoil;
        TensorWriter out;
        out.add("description", 1, {4}, std::vector<char>{'t', 'e', 's', 't'});
        out.add("phi_i", 10, {phiI.size()}, phiI);
        out.add("theta_i", 10, {thetaI.size()}, thetaI);
        out.add("sigma", 10, {kSize, kSize}, sigma);
        out.add("ndf", 10, {kSize, kSize}, ndf);
        out.add("vndf", 10, {phiI.size(), thetaI.size(), kSize, kSize}, vndf);
        out.add("rgb", 10, {phiI.size(), thetaI.size(), 3, kSize, kSize}, rgb);
        return out.bytes();
    }
};

double azimuth(const Vec3& v) { return std::atan2(v.y, v.x); }
double wrapped(double phi) { return phi - 2 * kPi * std::floor((phi + kPi) / (2 * kPi)); }
double relativeError(const Rgb& found, const Rgb& expected) {
    return glm::length(found - expected) / glm::length(expected);
}

constexpr double kSingle = 1e-5;  // tables in single precision

TEST(Rgl, IsotropicFileFollowsTheDefinition) {
    const Affine model;
    const RglTable table = parseRgl(model.bytes(), "affine");
    EXPECT_TRUE(table.isotropic);
    EXPECT_EQ(table.description, "test");
    for (const DirectionPair& pair : samplePairs(2000, kRglGrazing)) {
        const double phiM = wrapped(azimuth(halfVector(pair.wi, pair.wo)) - azimuth(pair.wi));
        const Rgb expected = model.f(0, phiM, pair.wi, pair.wo);
        EXPECT_LT(relativeError(evaluateRaw(table, pair.wi, pair.wo), expected), kSingle);
    }
    EXPECT_EQ(evaluateRaw(table, {1, 0, 0}, {0, 0, 1}), Rgb(0));
    EXPECT_EQ(evaluateRaw(table, {0, 0, 1}, {0, 0.6, -0.8}), Rgb(0));
}

TEST(Rgl, AnisotropicFilesWithEverySymmetry) {
    for (const int symmetry : {1, 2, 4}) {
        Affine model;
        model.phiI.clear();
        for (int i = 0; i <= 6; ++i) model.phiI.push_back(static_cast<float>(-kPi + 2 * kPi * i / 6 / symmetry));
        const RglTable table = parseRgl(model.bytes(), "affine");
        EXPECT_FALSE(table.isotropic);
        EXPECT_EQ(table.symmetry, symmetry);
        for (const DirectionPair& pair : samplePairs(2000, kRglGrazing)) {
            Vec3 wi = pair.wi, wo = pair.wo;  // by hand: the measured range is y ≤ 0, and then x ≤ 0
            if (symmetry >= 2 && wi.y > 0) wi = {-wi.x, -wi.y, wi.z}, wo = {-wo.x, -wo.y, wo.z};
            if (symmetry == 4 && wi.x > 0) wi.x = -wi.x, wo.x = -wo.x;
            const Rgb expected = model.f(azimuth(wi), azimuth(halfVector(wi, wo)), wi, wo);
            EXPECT_LT(relativeError(evaluateRaw(table, pair.wi, pair.wo), expected), kSingle) << symmetry;
            const Rgb swapped = evaluateSymmetric(table, pair.wo, pair.wi);
            EXPECT_LT(relativeError(evaluateSymmetric(table, pair.wi, pair.wo), swapped), 1e-12) << symmetry;
        }
    }
}

TEST(Rgl, NegativeAndNonFiniteNumbersAreCounted) {
    const RglTable negative = parseRgl(Affine{}.bytes(-50.0f), "x");
    EXPECT_EQ(negative.data.negative, 1u);
    EXPECT_EQ(negative.data.entries, static_cast<std::uint64_t>(25 + 3 * 25 + 9 * 25));
    for (const float spoil : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        EXPECT_EQ(parseRgl(Affine{}.bytes(spoil), "x").data.nonFinite, 1u);
    for (const DirectionPair& pair : samplePairs(2000, kPi / 2)) {
        const Rgb f = evaluateSymmetric(negative, pair.wi, pair.wo);
        EXPECT_TRUE(isFinite(f) && f.r >= 0 && f.g >= 0 && f.b >= 0);
    }
}

/// Parses; when that works, evaluates. Anything but success or a one-line nacre::Error fails the test.
void parsesOrComplains(const std::vector<std::uint8_t>& bytes, int& failures) {
    try {
        const RglTable table = parseRgl(bytes, "x.bsdf");
        for (const DirectionPair& pair : samplePairs(4, 1.5))
            EXPECT_TRUE(isFinite(evaluateSymmetric(table, pair.wi, pair.wo)));
    } catch (const Error& error) {
        ++failures;
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        EXPECT_EQ(std::string(error.what()).rfind("x.bsdf: ", 0), 0u);
    }
}

TEST(Rgl, TruncatedAnywhereIsAnError) {
    const std::vector<std::uint8_t> whole = Affine{}.bytes();
    int failures = 0;
    for (std::size_t size = 0; size < whole.size(); ++size)
        parsesOrComplains({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, failures);
    EXPECT_EQ(failures, static_cast<int>(whole.size()));
}

TEST(Rgl, CorruptBytesNeverCrash) {
    std::vector<std::uint8_t> bytes = Affine{}.bytes();
    int failures = 0, tried = 0;
    for (std::uint8_t& byte : bytes)
        for (const int flip : {0x01, 0x80, 0xff, 0x40}) {
            const std::uint8_t kept = byte;
            byte = static_cast<std::uint8_t>(byte ^ flip);
            parsesOrComplains(bytes, failures);
            byte = kept;
            ++tried;
        }
    EXPECT_GT(failures, 500);
    EXPECT_LT(failures, tried);
}

TEST(Rgl, MessagesNameFieldExpectedAndFound) {
    const auto message = [](const std::vector<std::uint8_t>& bytes) {
        return messageOf<Error>([&] { parseRgl(bytes, "x.bsdf"); });
    };
    EXPECT_THAT(message({}), HasSubstr("x.bsdf: expected 12 bytes of a tensor file's signature"));
    EXPECT_THAT(message(std::vector<std::uint8_t>(100, 'a')), HasSubstr("expected a tensor file, found"));
    TensorWriter none;
    EXPECT_THAT(message(none.bytes()), HasSubstr("expected a field 'phi_i', found none"));
    none.add("phi_i", 11, {1}, std::vector<double>{0});
    EXPECT_THAT(message(none.bytes()), HasSubstr("field 'phi_i': expected float32 [≥ 1], found float64 [1]"));
    TensorWriter huge;
    huge.add("phi_i", 10, {1ull << 40, 1ull << 40}, std::vector<float>{0});
    EXPECT_THAT(message(huge.bytes()), HasSubstr("found a file of"));
    std::vector<std::uint8_t> longer = Affine{}.bytes();
    longer.push_back(0);
    EXPECT_THAT(message(longer), HasSubstr("expected the last field to end the file at"));
    Affine model;
    model.phiI = {-3, -2, -1};
    EXPECT_THAT(message(model.bytes()), HasSubstr("field 'phi_i': expected a span of 2π, π or π/2, found 2"));
    model.phiI = {0};
    model.thetaI = {0, 0};
    EXPECT_THAT(message(model.bytes()), HasSubstr("field 'theta_i': expected finite ascending angles, found 0 at 1"));
}

// ---- real files

const std::array<const char*, 3> kFiles = {"paper_white", "satin_rosaline", "cc_ibiza_sunset"};

std::vector<std::filesystem::path> realFiles() {
    std::vector<std::filesystem::path> out;
    for (const char* name : kFiles) {
        const auto path = sharedFile(fmt::format("brdf/{}_rgb.bsdf", name));
        if (!path.empty()) out.push_back(path);
    }
    return out;
}

/// ∫ f cosθo dωo per channel.
Rgb albedo(const BrdfFunction& f, const Vec3& wi) {
    constexpr std::uint64_t kSamples = 8192;
    Rgb sum(0);
    for (std::uint64_t i = 1; i <= kSamples; ++i)
        sum += f(wi, cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)}));
    return sum * (kPi / kSamples);
}

TEST(RglRealFiles, LuminanceFieldIsTheLuminanceOfRgb) {
    if (realFiles().empty()) GTEST_SKIP() << "no ../shared/data/brdf (or NACRE_SHARED)";
    constexpr double kRounding = 1e-3;  // of the file's single precision where the three channels nearly cancel
    for (const auto& path : realFiles()) {
        const auto bytes = readFile(path, 1 << 26);
        const RglTable table = parseRgl(bytes, path.string());
        const auto fields = parseTensorFile(bytes, path.string());
        const auto stored = floatsOf(tensorField(fields, "luminance", TensorField::Float, {0, 0, 0, 0}, path.string()));
        ASSERT_EQ(stored.size(), table.values.size());
        for (std::size_t i = 0; i < stored.size(); ++i)
            if (stored[i] > 0.01) {
                EXPECT_NEAR(luminance(table.values[i]) / stored[i], 1, kRounding);
            }
    }
}

TEST(RglRealFiles, WhitePaperIsAFlatWhiteDiffuser) {
    const auto path = sharedFile("brdf/paper_white_rgb.bsdf");
    if (path.empty()) GTEST_SKIP() << "no ../shared/data/brdf (or NACRE_SHARED)";
    const Reflectance paper = openRgl(path);
    for (const double thetaDeg : {0, 20, 40, 60, 70}) {
        const Rgb a = albedo(paper.f, sphericalDirection(thetaDeg * kPi / 180, 0.4));
        EXPECT_NEAR(a.r, 0.835, 0.025) << thetaDeg;  // measured 0.82 to 0.85
        EXPECT_NEAR(a.b, 0.98, 0.03) << thetaDeg;    // bluish: optical brighteners
    }
    EXPECT_LT(paper.reciprocityResidual, 0.06);  // measured 0.040; without the cosine's division 0.42
}

TEST(RglRealFiles, EnergyIsConservedBelowSeventyDegrees) {
    if (realFiles().empty()) GTEST_SKIP() << "no ../shared/data/brdf (or NACRE_SHARED)";
    for (const auto& path : realFiles()) {
        const Reflectance reflectance = openRgl(path);
        for (const double thetaDeg : {0, 30, 60, 70})
            EXPECT_LE(maxComponent(albedo(reflectance.f, sphericalDirection(thetaDeg * kPi / 180, 0))), 1.0)
                << path << ' ' << thetaDeg;
    }
}

TEST(RglRealFiles, ReciprocalMirroredContinuousAndFiniteAtGrazing) {
    if (realFiles().empty()) GTEST_SKIP() << "no ../shared/data/brdf (or NACRE_SHARED)";
    for (const auto& path : realFiles()) {
        const Reflectance r = openRgl(path);
        EXPECT_EQ(r.kind, "rgl");
        EXPECT_GT(r.reciprocityResidual, 0.01);
        EXPECT_LT(r.reciprocityResidual, 0.7);
        for (const DirectionPair& pair : samplePairs(2000, 89.9 * kPi / 180)) {
            const Rgb f = r.f(pair.wi, pair.wo), mean = f + 1e-6;
            ASSERT_TRUE(isFinite(f) && f.r >= 0 && f.g >= 0 && f.b >= 0);
            EXPECT_LT(relativeError(r.f(pair.wo, pair.wi) + 1e-6, mean), 1e-9);
            const Vec3 wiMirrored(pair.wi.x, -pair.wi.y, pair.wi.z), woMirrored(pair.wo.x, -pair.wo.y, pair.wo.z);
            EXPECT_LT(relativeError(r.f(wiMirrored, woMirrored) + 1e-6, mean),
                      2e-4);  // single-precision cdfs, at their steepest
        }
        const RglTable table = parseRgl(readFile(path, 1 << 26), "x");
        for (const float theta : table.thetaI) {  // slices meet
            if (theta <= 0 || theta > 1.4) continue;
            const Vec3 wo = sphericalDirection(theta + 0.05, kPi);
            const Rgb below = evaluateRaw(table, sphericalDirection(theta - 1e-6, 0), wo);
            const Rgb above = evaluateRaw(table, sphericalDirection(theta + 1e-6, 0), wo);
            EXPECT_LT(relativeError(above, below), 1e-3) << path << ' ' << theta;
        }
    }
}

TEST(RglRealFiles, TruncatedAtManyPlacesIsAnError) {
    if (realFiles().empty()) GTEST_SKIP() << "no ../shared/data/brdf (or NACRE_SHARED)";
    const std::vector<std::uint8_t> whole = readFile(realFiles()[0], 1 << 26);
    for (std::size_t size = 1; size < whole.size(); size += whole.size() / 61)
        EXPECT_THAT(messageOf<Error>([&] { parseRgl({whole.data(), size}, "x.bsdf"); }), HasSubstr("x.bsdf: ")) << size;
}

TEST(Reciprocity, ResidualOfAKnownAsymmetry) {
    const auto lambert = [](const Vec3&, const Vec3&) { return Rgb(0.3); };
    EXPECT_EQ(reciprocityResidual(lambert), 0.0);
    EXPECT_EQ(reciprocityResidual([](const Vec3&, const Vec3&) { return Rgb(0); }), 0.0);
    // f = cosθi: ∫(a − b)² a b / ∫ a² a b over [c, 1]², c = cos 80°, with moments M_k = (1 − c^(k+1))/(k + 1)
    // = 2 (M3 M1 − M2²) / (M3 M1) [dωi dωo = da db dφ].
    const double c = std::cos(80 * kPi / 180);
    const auto moment = [&](int k) { return (1 - std::pow(c, k + 1)) / (k + 1); };
    const double expected = std::sqrt(2 * (moment(3) * moment(1) - sqr(moment(2))) / (moment(3) * moment(1)));
    EXPECT_NEAR(reciprocityResidual([](const Vec3& wi, const Vec3&) { return Rgb(wi.z); }), expected, 0.01 * expected);
}

}  // namespace
}  // namespace nacre
