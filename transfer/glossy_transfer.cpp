#include "transfer/glossy_transfer.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "transfer/mask_tables.hpp"

namespace nacre {
namespace {

constexpr std::size_t kElevations = 129;  // of the viewer, 0 at the normal, the last at the horizon
constexpr int kRows = 256, kSteps = 128;  // of the table's directions: azimuths, steps of sin²θ

std::size_t countOf(int order) { return static_cast<std::size_t>((order + 1) * (order + 1)); }

}  // namespace

GlossyTransfer::GlossyTransfer(int size, int order, MaskDetail detail, BrdfOfDirections brdf)
    : masks_(size, order, detail),
      order_(order),
      rotation_(order),
      brdf_(std::move(brdf)),
      open_(kElevations * countOf(order)) {
    std::vector<glm::vec3> directions;
    std::vector<double> harmonics;
    for (int row = 0; row < kRows; ++row)
        for (int step = 0; step < kSteps; ++step) {
            const double u = (step + 0.5) / kSteps, phi = 2 * kPi * (row + 0.5) / kRows;
            directions.emplace_back(std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u));
            for (int l = 0; l <= order; ++l)
                for (int m = -l; m <= l; ++m) harmonics.push_back(harmonicAt(l, m, std::sqrt(1 - u), phi));
        }
    const std::size_t count = countOf(order);
    parallelFor(kElevations, 0, [&](std::size_t e) {
        const double theta = 0.5 * kPi * static_cast<double>(e) / (kElevations - 1);
        std::vector<float> f(directions.size());
        std::vector<double> sums(count, 0);
        brdf_(glm::vec3(std::sin(theta), 0, std::cos(theta)), directions, f);
        for (std::size_t d = 0; d < directions.size(); ++d)
            for (std::size_t c = 0; c < count; ++c) sums[c] += f[d] * harmonics[d * count + c];
        for (std::size_t c = 0; c < count; ++c)
            open_[e * count + c] = static_cast<float>(sums[c] * kPi / static_cast<double>(directions.size()));
    });
}

/// The table's transfer at an elevation, in lane 1 of HarmonicRotation's layout.
void GlossyTransfer::addOpen(float cosine, std::span<float> local) const {
    const std::size_t count = countOf(order_);
    const float at = std::acos(std::min(cosine, 1.0f)) / static_cast<float>(0.5 * kPi) * (kElevations - 1);
    const std::size_t e = std::min(static_cast<std::size_t>(at), kElevations - 2);
    const float share = at - static_cast<float>(e);
    for (std::size_t c = 0; c < count; ++c)
        local[c * kLanes + 1] = (1 - share) * open_[e * count + c] + share * open_[(e + 1) * count + c];
}

void GlossyTransfer::transfer(const Receiver& receiver, std::span<const std::uint32_t> mask, const glm::vec3& toEye,
                              std::span<float> world) const {
    const std::size_t count = countOf(order_);
    const glm::vec3 wo(glm::dot(toEye, receiver.tangent), glm::dot(toEye, receiver.bitangent),
                       glm::dot(toEye, receiver.normal));
    std::fill(world.begin(), world.end(), 0.0f);
    if (wo.z <= 0) return;
    std::vector<float> local(count * kLanes, 0.0f), both(2 * count), hidden(count);
    masks_.hidden(mask, wo, brdf_, hidden);
    for (std::size_t c = 0; c < count; ++c) local[c * kLanes] = hidden[c];
    addOpen(wo.z, local);
    Receiver toViewer = receiver;  // x towards the viewer
    const float across = std::hypot(wo.x, wo.y);
    if (across > 0) {
        toViewer.tangent = (wo.x * receiver.tangent + wo.y * receiver.bitangent) / across;
        toViewer.bitangent = glm::cross(toViewer.normal, toViewer.tangent);
    }
    const Receiver frames[2] = {receiver, toViewer};
    rotation_.turn(frames, 2, local.data(), both.data());
    for (std::size_t c = 0; c < count; ++c) world[c] = both[count + c] - both[c];
}

GlossyFrame computeLobes(const SelfTransfer& transfer, std::span<const glm::vec3> positions,
                         std::span<const GlossyTransfer* const> lobes, const Vec3& eye,
                         std::span<const std::uint8_t> wanted) {
    require(isFinite(eye), "glossy transfer: expected a finite eye");
    const std::size_t count = countOf(transfer.options().order);
    GlossyFrame out{{}, std::vector<std::vector<float>>(lobes.size(), std::vector<float>(positions.size() * count, 0))};
    out.diffuse = transfer.compute(
        positions, wanted, [&](std::uint32_t vertex, const Receiver& receiver, std::span<const std::uint32_t> mask) {
            const Vec3 toEye = eye - Vec3(positions[vertex]);
            const double distance = glm::length(toEye);
            if (!(distance > 0)) return;
            for (std::size_t i = 0; i < lobes.size(); ++i)
                lobes[i]->transfer(receiver, mask, toEye / distance,
                                   std::span(out.lobes[i]).subspan(vertex * count, count));
        });
    return out;
}

TransferFrame computeGlossy(const SelfTransfer& transfer, std::span<const glm::vec3> positions,
                            const GlossyTransfer& lobe, double specular, const Vec3& eye,
                            std::span<const std::uint8_t> wanted) {
    require(specular >= 0 && specular <= 1, "glossy transfer: expected a share of 0 to 1");
    const GlossyTransfer* const lobes[] = {&lobe};
    GlossyFrame both = computeLobes(transfer, positions, lobes, eye, wanted);
    std::vector<float>& out = both.diffuse.coefficients;
    const auto share = static_cast<float>(specular);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = (1 - share) * out[i] + share * both.lobes[0][i];
    return std::move(both.diffuse);
}

}  // namespace nacre
