#include "transfer/harmonic_rotation.hpp"

#include <Eigen/Dense>
#include <array>
#include <cstring>
#include <random>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/error.hpp"
#include "core/math.hpp"

namespace nacre {
namespace {

#define NACRE_KERNEL "transfer/harmonic_rotation.inl"
#include "core/wide.inl"

using Turn = void (*)(const float*, const float*, const float*, const float*, const float*, float*);

template <int... L>
std::array<Turn, sizeof...(L)> turns(std::integer_sequence<int, L...>) {
    return {NACRE_WIDEST(turn16<L>)...};
}
const auto kTurns = turns(std::make_integer_sequence<int, kMaxTransferOrder + 1>{});

/// y_lm with P_lm / ((2m − 1)!! sin^m) factored out: what addHarmonics multiplies by. Entry l(l + 1)/2 + m.
std::vector<float> scalesOf(int order) {
    std::vector<float> scales;
    for (int l = 0; l <= order; ++l)
        for (int m = 0; m <= l; ++m) {
            double s = (2 * l + 1) / (4 * kPi) * (m > 0 ? 2 : 1);
            for (int i = l - m + 1; i <= l + m; ++i) s /= i;
            s = std::sqrt(s);
            for (int i = 1; i <= m; ++i) s *= 2 * i - 1;
            scales.push_back(static_cast<float>(s));
        }
    return scales;
}

}  // namespace

/// The best-conditioned of 300 sets of random directions, by the worst band; deterministic.
HarmonicRotation::HarmonicRotation(int order) : order_(order) {
    require(order >= 0 && order <= kMaxTransferOrder, "transfer: expected an order of 0 to 6");
    scales_ = scalesOf(order);
    const int count = 2 * order + 1;
    std::mt19937 random(1);
    const auto uniform = [&] {
        return static_cast<double>(random()) / 4294967296.0;
    };  // std's distributions differ between libraries
    double best = 0;
    for (int attempt = 0; attempt < 300; ++attempt) {
        std::vector<Vec3> directions;
        for (int j = 0; j < count; ++j) {
            const double z = 2 * uniform() - 1, phi = 2 * kPi * uniform(), s = std::sqrt(1 - z * z);
            directions.emplace_back(s * std::cos(phi), s * std::sin(phi), z);
        }
        std::vector<Eigen::MatrixXd> inverses;
        double worst = 1e30;
        for (int l = 0; l <= order; ++l) {
            Eigen::MatrixXd basis(2 * l + 1, count);
            for (int j = 0; j < count; ++j) {
                const Vec3& d = directions[static_cast<std::size_t>(j)];
                for (int m = -l; m <= l; ++m) basis(l + m, j) = harmonicAt(l, m, d.z, std::atan2(d.y, d.x));
            }
            const Eigen::JacobiSVD<Eigen::MatrixXd> svd(basis, Eigen::ComputeThinU | Eigen::ComputeThinV);
            worst = std::min(worst, svd.singularValues().minCoeff());
            if (worst <= best) break;
            inverses.push_back(svd.matrixV() * svd.singularValues().cwiseInverse().asDiagonal() *
                               svd.matrixU().transpose());
        }
        if (worst <= best) continue;
        best = worst;
        directions_.clear();
        weights_.clear();
        for (const Vec3& d : directions)
            for (int k = 0; k < 3; ++k) directions_.push_back(static_cast<float>(d[k]));
        for (const Eigen::MatrixXd& inverse : inverses)
            for (int m = 0; m < inverse.cols(); ++m)
                for (int j = 0; j < count; ++j) weights_.push_back(static_cast<float>(inverse(j, m)));
    }
}

void HarmonicRotation::turn(const Receiver* receivers, std::size_t count, const float* local, float* world) const {
    const std::size_t size = static_cast<std::size_t>((order_ + 1) * (order_ + 1));
    constexpr std::size_t kMost = static_cast<std::size_t>((kMaxTransferOrder + 1) * (kMaxTransferOrder + 1)) * kLanes;
    alignas(64) float frames[9 * kLanes] = {}, turned[kMost];
    for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
            frames[static_cast<std::size_t>(k) * kLanes + i] = receivers[i].tangent[k];
            frames[static_cast<std::size_t>(3 + k) * kLanes + i] = receivers[i].bitangent[k];
            frames[static_cast<std::size_t>(6 + k) * kLanes + i] = receivers[i].normal[k];
        }
    kTurns[static_cast<std::size_t>(order_)](scales_.data(), directions_.data(), weights_.data(), frames, local,
                                             turned);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < size; ++c) world[i * size + c] = turned[c * kLanes + i];
}

}  // namespace nacre
