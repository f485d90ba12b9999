#include "transfer/mask_shading.hpp"

#include <gtest/gtest.h>

#include "envmaps/spherical_harmonics.hpp"

namespace nacre {
namespace {

Receiver tilted() {
    Receiver r;
    r.normal = glm::normalize(glm::vec3(0.3f, 0.5f, -0.8f));
    r.tangent = glm::normalize(glm::cross(r.normal, glm::vec3(0, 1, 0)));
    r.bitangent = glm::cross(r.normal, r.tangent);
    return r;
}

/// The half of the disk with x > 0: rows of azimuths below a quarter and above three.
std::vector<std::uint32_t> halfHidden(int size) {
    std::vector<std::uint32_t> mask(maskWords(size), 0);
    for (int row = 0; row < size; ++row)
        if (row < size / 4 || row >= 3 * size / 4)
            for (std::size_t word = 0; word < mask.size(); word += static_cast<std::size_t>(size))
                mask[word + static_cast<std::size_t>(row)] = ~0u;
    return mask;
}

TEST(MaskShading, ADiffuseLobeIsTheDiffuseTransfer) {
    for (const MaskDetail detail : {MaskDetail::Blocks, MaskDetail::Bits}) {
        const MaskShading shading(32, 4, detail);
        EXPECT_EQ(shading.cells(), detail == MaskDetail::Blocks ? 64u : 1024u);
        const Receiver r = tilted();
        std::vector<float> world(25);
        const std::vector<std::uint32_t> open(32, 0);
        shading.glossy(
            r, open, r.normal, [](auto, auto, std::span<float> f) { std::fill(f.begin(), f.end(), 1 / 3.14159265f); },
            world);
        const std::vector<double> zonal = openTransfer(4), y = realHarmonics(4, r.normal);
        for (int l = 0; l <= 4; ++l)
            for (int c = l * l; c < (l + 1) * (l + 1); ++c)
                EXPECT_NEAR(world[static_cast<std::size_t>(c)],
                            zonal[static_cast<std::size_t>(l)] * std::sqrt(4 * kPi / (2 * l + 1)) *
                                y[static_cast<std::size_t>(c)],
                            2e-3);
    }
}

TEST(MaskShading,
     HalfTheSkyIsHalfTheLight) {  // Σ over the sky; a light that leans to x loses ∫ x over the hidden half: 4/3π of it
    const MaskShading shading(32, 4, MaskDetail::Bits);
    const Receiver r = tilted();
    const std::vector<std::uint32_t> mask = halfHidden(32);
    EXPECT_NEAR(shading.direct(r, mask, [](const Vec3&) { return Rgb(1); }).r, 0.5, 1e-6);
    const Rgb leaning = shading.direct(r, mask, [&](const Vec3& d) { return Rgb(glm::dot(d, Vec3(r.tangent))); });
    EXPECT_NEAR(leaning.r, -2 / (3 * kPi), 2e-3);
}

TEST(MaskShading, PhongFollowsTheMirror) {
    const MaskShading shading(64, 6, MaskDetail::Bits);
    const Receiver r = tilted();
    const glm::vec3 toEye = glm::normalize(0.7f * r.normal + 0.7f * r.tangent),
                    mirrored = glm::normalize(0.7f * r.normal - 0.7f * r.tangent);
    std::vector<float> open(49), hidden(49);
    const std::vector<std::uint32_t> none(maskWords(64), 0);
    shading.glossy(r, none, toEye, phongBrdf(50), open);
    const auto at = [&](const std::vector<float>& v, const glm::vec3& d) {
        const std::vector<double> y = realHarmonics(6, d);
        double sum = 0;
        for (std::size_t c = 0; c < 49; ++c) sum += v[c] * y[c];
        return sum;
    };
    EXPECT_GT(at(open, mirrored), 2 * std::abs(at(open, r.normal)));
    // The integral is y_00's coefficient times √4π: the lobe's cosine-weighted albedo, here cos 45° × 52/51.. of it.
    EXPECT_NEAR(open[0] * std::sqrt(4 * kPi), std::sqrt(0.5), 0.03);
    std::vector<std::uint32_t> mask = halfHidden(64);  // x > 0 hidden: the eye's side; the mirrored lobe stays
    shading.glossy(r, mask, toEye, phongBrdf(50), hidden);
    EXPECT_NEAR(hidden[0], open[0], 0.01 * open[0]);
    shading.glossy(r, mask, mirrored, phongBrdf(50), hidden);
    EXPECT_NEAR(hidden[0], 0, 0.01 * open[0]);
    shading.glossy(r, none, -r.normal, phongBrdf(50), hidden);
    EXPECT_EQ(hidden, std::vector<float>(49, 0));
}

TEST(MaskShading, Refuses) {
    EXPECT_THROW(MaskShading(20, 4, MaskDetail::Bits), std::invalid_argument);
    EXPECT_THROW(phongBrdf(-1), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
