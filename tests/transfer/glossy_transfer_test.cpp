#include "transfer/glossy_transfer.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "reference/glossy_trace.hpp"
#include "reference/transfer_trace.hpp"
#include "transfer/cloth.hpp"

namespace nacre {
namespace {

constexpr std::size_t kCount = 25;

BrdfOfDirections matt() {
    return [](auto, auto, std::span<float> f) { std::fill(f.begin(), f.end(), static_cast<float>(1 / kPi)); };
}

/// A frame of the cloth over its floor.
struct Draped {
    SelfTransfer transfer;
    std::vector<glm::vec3> positions;
    Vec3 eye{1, 3, 4};

    explicit Draped(const SelfTransferOptions& options = {}) : Draped(clothAnimation({.frames = 60}), options) {}

private:
    Draped(const AnimatedMesh& animation, const SelfTransferOptions& options)
        : transfer(make(animation, options)), positions(weldedPositions(transfer.mesh(), animation.frames[50])) {}
    static SelfTransfer make(const AnimatedMesh& animation, const SelfTransferOptions& options) {
        WeldedMesh mesh = weldMesh(animation, "cloth");
        const std::vector<glm::vec3> rest = weldedPositions(mesh, animation.frames[0]);
        return {std::move(mesh), rest, options};
    }
};

TransferError errorOf(const Draped& d, const TransferFrame& found, const IsotropicBrdf& f, std::size_t rays) {
    return transferError(
        found.coefficients,
        tracedGlossyTransfer(d.transfer.mesh().triangles, d.positions, found.normals, d.eye, f, 4, rays), kCount);
}

TEST(GlossyTransfer, AMattLobeIsTheDiffuseTransfer) {  // of vertices that face the eye
    const Draped d;
    const GlossyTransfer lobe(32, 4, MaskDetail::Bits, matt());
    const TransferFrame glossy = computeGlossy(d.transfer, d.positions, lobe, 1, d.eye),
                        diffuse = d.transfer.compute(d.positions);
    double off = 0, all = 0;
    std::size_t away = 0;
    for (std::size_t v = 0; v < d.positions.size(); ++v) {
        const bool faces = glm::dot(Vec3(glossy.normals[v]), d.eye - Vec3(d.positions[v])) > 0;
        away += !faces;
        for (std::size_t c = v * kCount; c < (v + 1) * kCount; ++c) {
            if (!faces) {
                EXPECT_EQ(glossy.coefficients[c], 0);
            }
            off += faces ? sqr(glossy.coefficients[c] - diffuse.coefficients[c]) : 0;
            all += faces ? sqr(diffuse.coefficients[c]) : 0;
        }
    }
    EXPECT_LT(std::sqrt(off / all), 5e-3);
    EXPECT_GT(away, 100u);
}

TEST(GlossyTransfer, PhongLobesAreNearRays) {
    constexpr double kBits = 0.015;  // measured about 0.01, the rays' noise in it
    const Draped d({.coarse = 0});   // the masks themselves, without what levels of detail err
    for (const double n : {5.0, 20.0, 50.0}) {
        const auto error = [&](MaskDetail detail) {
            const GlossyTransfer lobe(32, 4, detail, phongBrdf(static_cast<float>(n)));
            return errorOf(d, computeGlossy(d.transfer, d.positions, lobe, 1, d.eye), phongLobe(n), 2048).total;
        };
        const double bits = error(MaskDetail::Bits);
        EXPECT_LT(bits, kBits) << n;
        EXPECT_GT(error(MaskDetail::Blocks), 3 * bits) << "4 x 4 bits are wider than the lobe, exponent " << n;
    }
}

TEST(GlossyTransfer, AnOpenPointHasTheTablesTransfer) {  // y_00's coefficient times √4π: the lobe's albedo at wo
    const GlossyTransfer lobe(32, 4, MaskDetail::Bits, phongBrdf(0));  // f = 1/π on the mirrored view's side
    const Receiver receiver = receiverAt(glm::vec3(0), glm::normalize(glm::vec3(1, 2, -3)));
    std::vector<float> world(kCount);
    const std::vector<std::uint32_t> open(maskWords(32), 0), closed(maskWords(32), ~0u);
    lobe.transfer(receiver, open, receiver.normal, world);
    EXPECT_NEAR(world[0] * std::sqrt(4 * kPi), 1, 1e-4);
    // At 60 degrees a part of the hemisphere lies behind the mirrored view: (1 + cos θ)/2 of the cosine stays.
    lobe.transfer(receiver, open, 0.5f * receiver.normal + std::sqrt(0.75f) * receiver.tangent, world);
    EXPECT_NEAR(world[0] * std::sqrt(4 * kPi), 0.75, 2e-3);
    lobe.transfer(receiver, closed, receiver.normal, world);
    for (const float v : world) EXPECT_NEAR(v, 0, 5e-3);
    lobe.transfer(receiver, open, -receiver.normal, world);
    EXPECT_EQ(world, std::vector<float>(kCount, 0));
}

TEST(GlossyTransfer, MixesWithTheMattShare) {
    const Draped d;
    const GlossyTransfer lobe(32, 4, MaskDetail::Bits, phongBrdf(10));
    const GlossyTransfer* const lobes[] = {&lobe};
    const GlossyFrame both = computeLobes(d.transfer, d.positions, lobes, d.eye);
    const std::vector<float> mixed = computeGlossy(d.transfer, d.positions, lobe, 0.25, d.eye).coefficients;
    EXPECT_EQ(both.diffuse.coefficients, d.transfer.compute(d.positions).coefficients);
    for (std::size_t i = 0; i < mixed.size(); ++i)
        EXPECT_FLOAT_EQ(mixed[i], 0.75f * both.diffuse.coefficients[i] + 0.25f * both.lobes[0][i]);
}

TEST(GlossyTransfer, Refuses) {
    const Draped d;
    const GlossyTransfer lobe(32, 4, MaskDetail::Blocks, phongBrdf(10));
    EXPECT_THROW(computeGlossy(d.transfer, d.positions, lobe, 1.5, d.eye), std::invalid_argument);
    EXPECT_THROW(computeGlossy(d.transfer, d.positions, lobe, 1, Vec3(NAN)), std::invalid_argument);
    EXPECT_THROW(GlossyTransfer(20, 4, MaskDetail::Bits, phongBrdf(10)), std::invalid_argument);
    EXPECT_THROW(phongLobe(-1), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
