#include "transfer/mask_shading.hpp"

#include <bit>

#include "core/error.hpp"

namespace nacre {
BrdfOfDirections phongBrdf(float exponent) {
    require(std::isfinite(exponent) && exponent >= 0, "phongBrdf: exponent must be finite, >= 0");
    return [exponent](const glm::vec3& wo, std::span<const glm::vec3> wi, std::span<float> f) {
        const glm::vec3 r(-wo.x, -wo.y, wo.z);
        const float scale = (exponent + 2) / static_cast<float>(2 * kPi);
        for (std::size_t i = 0; i < wi.size(); ++i) {
            const float c = glm::dot(r, wi[i]);
            f[i] = c > 0 ? scale * std::pow(c, exponent) : 0;
        }
    };
}

MaskShading::MaskShading(int size, int order, MaskDetail detail)
    : size_(size), order_(order), block_(detail == MaskDetail::Blocks ? 4 : 1), rotation_(order) {
    maskKernel(size);  // throws for sizes that no mask has
    const int edge = size / block_;
    constexpr int kPoints = 4;  // a cell's mean harmonic, by points along either side
    for (int row = 0; row < edge; ++row)
        for (int step = 0; step < edge; ++step) {
            const double u = (step + 0.5) / edge, phi = 2 * kPi * (row + 0.5) / edge;
            directions_.emplace_back(std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u));
            for (int l = 0; l <= order; ++l)
                for (int m = -l; m <= l; ++m) {
                    double sum = 0;
                    for (int i = 0; i < kPoints; ++i)
                        for (int j = 0; j < kPoints; ++j)
                            sum += harmonicAt(l, m, std::sqrt(1 - (step + (i + 0.5) / kPoints) / edge),
                                              2 * kPi * (row + (j + 0.5) / kPoints) / edge);
                    harmonics_.push_back(static_cast<float>(sum / (kPoints * kPoints)));
                }
        }
}

/// Share of a cell that nothing hides.
float MaskShading::open(std::span<const std::uint32_t> mask, std::size_t cell) const {
    const int edge = size_ / block_, row = static_cast<int>(cell) / edge * block_,
              step = static_cast<int>(cell) % edge * block_;
    int hidden = 0;
    for (int r = row; r < row + block_; ++r)
        hidden +=
            std::popcount(mask[static_cast<std::size_t>(step / 32 * size_ + r)] >> (step % 32) & ((1u << block_) - 1));
    return 1 - static_cast<float>(hidden) / static_cast<float>(block_ * block_);
}

void MaskShading::glossy(const Receiver& receiver, std::span<const std::uint32_t> mask, const glm::vec3& toEye,
                         const BrdfOfDirections& brdf, std::span<float> world) const {
    const std::size_t count = static_cast<std::size_t>((order_ + 1) * (order_ + 1));
    const glm::vec3 wo(glm::dot(toEye, receiver.tangent), glm::dot(toEye, receiver.bitangent),
                       glm::dot(toEye, receiver.normal));
    std::fill(world.begin(), world.end(), 0.0f);
    if (wo.z <= 0) return;
    std::vector<float> f(cells()), local(count * kLanes, 0.0f);
    brdf(wo, directions_, f);
    const float weight = static_cast<float>(kPi / static_cast<double>(cells()));
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        const float value = weight * f[cell] * open(mask, cell);
        for (std::size_t c = 0; c < count; ++c) local[c * kLanes] += value * harmonics_[cell * count + c];
    }
    rotation_.turn(&receiver, 1, local.data(), world.data());
}

void MaskShading::hidden(std::span<const std::uint32_t> mask, const glm::vec3& wo, const BrdfOfDirections& brdf,
                         std::span<float> local) const {
    struct Hidden {
        std::vector<glm::vec3> directions;
        std::vector<std::size_t> cells;
        std::vector<float> shares, f;
    };
    static thread_local Hidden found;
    found.directions.clear(), found.cells.clear(), found.shares.clear();
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        const float share = 1 - open(mask, cell);
        if (share == 0) continue;
        found.directions.push_back(directions_[cell]);
        found.cells.push_back(cell);
        found.shares.push_back(share);
    }
    found.f.resize(found.cells.size());
    brdf(wo, found.directions, found.f);
    std::fill(local.begin(), local.end(), 0.0f);
    const float weight = static_cast<float>(kPi / static_cast<double>(cells()));
    for (std::size_t i = 0; i < found.cells.size(); ++i) {
        const float value = weight * found.f[i] * found.shares[i];
        for (std::size_t c = 0; c < local.size(); ++c)
            local[c] += value * harmonics_[found.cells[i] * local.size() + c];
    }
}

Rgb MaskShading::direct(const Receiver& receiver, std::span<const std::uint32_t> mask,
                        const std::function<Rgb(const Vec3&)>& light) const {
    Rgb sum(0);
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        const float share = open(mask, cell);
        if (share == 0) continue;
        const glm::vec3& d = directions_[cell];
        sum += double{share} * light(Vec3(d.x * receiver.tangent + d.y * receiver.bitangent + d.z * receiver.normal));
    }
    return sum / static_cast<double>(cells());
}

}  // namespace nacre
