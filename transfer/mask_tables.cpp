#include "transfer/mask_tables.hpp"

#include <cmath>
#include <stdexcept>

#include "core/error.hpp"
#include "core/math.hpp"
#include "core/sampling.hpp"

namespace nacre {

double harmonicOfHeight(int l, int m, double x) {
    double scale = (2 * l + 1) / (4 * kPi) * (m > 0 ? 2 : 1);
    for (int i = l - m + 1; i <= l + m; ++i) scale /= i;
    const double s = std::sqrt(std::max(0.0, 1 - x * x));
    double below = 0, here = std::sqrt(scale);  // P_{m−1,m} and P_mm = (2m − 1)!! sin^m, scaled
    for (int i = 1; i <= m; ++i) here *= (2 * i - 1) * s;
    for (int k = m + 1; k <= l; ++k) {
        const double next = ((2 * k - 1) * x * here - (k + m - 1) * below) / (k - m);
        below = here;
        here = next;
    }
    return here;
}

double harmonicAt(int l, int m, double z, double phi) {
    const double p = harmonicOfHeight(l, std::abs(m), z);
    return m < 0 ? p * std::sin(-m * phi) : p * std::cos(m * phi);
}

std::vector<double> openTransfer(int order) {
    std::vector<double> open;
    constexpr int kSteps = 4096;  // midpoint in cosθ: 2 ∫ K P_l(x) x dx
    for (int l = 0; l <= order; ++l) {
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double x = (i + 0.5) / kSteps;
            sum += harmonicOfHeight(l, 0, x) * 2 * x / kSteps;
        }
        open.push_back(sum);
    }
    return open;
}

static void checkSize(int size) {
    require(size == 16 || size == 32 || size == 64 || size == 128, "mask: expected a size of 16, 32, 64 or 128");
}

std::shared_ptr<const MaskRows> maskRows(int size) {
    checkSize(size);
    auto rows = std::make_shared<MaskRows>();
    for (int r = 0; r < size; ++r) {
        const double phi = 2 * kPi * (r + 0.5) / size;
        rows->cosPhi[r] = static_cast<float>(std::cos(phi));
        rows->sinPhi[r] = static_cast<float>(std::sin(phi));
        // Bit-reversed order: rows side by side, and any few rows, have offsets that spread.
        if (r < size / 8) rows->tangents[r] = static_cast<float>(std::tan(phi));
        rows->dither[r] = static_cast<float>(radicalInverse(static_cast<std::uint64_t>(r), 2) + 0.5 / size);
    }
    rows->windows.resize(static_cast<std::size_t>(size));
    rows->halves.resize(static_cast<std::size_t>(size));
    for (int w = 0; w < size; ++w) {
        MaskRows::Window& window = rows->windows[static_cast<std::size_t>(w)];
        window = {};
        for (int k = 0; k < kLanes; ++k) {
            const int row = (w + k) % size, lane = row % kLanes;
            window.cosPhi[lane] = rows->cosPhi[row];
            window.sinPhi[lane] = rows->sinPhi[row];
            window.dither[lane] = rows->dither[row];
            window.inBlock[row / kLanes][lane] = ~0u;
        }
        MaskRows::HalfWindow& half = rows->halves[static_cast<std::size_t>(w)];
        half = {};
        for (int k = 0; k < kLanes / 2; ++k) {
            const int row = (w + k) % size, lane = row % (kLanes / 2);
            half.cosPhi[lane] = rows->cosPhi[row];
            half.sinPhi[lane] = rows->sinPhi[row];
            half.dither[lane] = rows->dither[row];
            half.inBlock[row / kLanes][row % kLanes] = ~0u;
        }
    }
    return rows;
}

std::shared_ptr<const MaskIntegrals> maskIntegrals(int size, int order) {
    checkSize(size);
    require(order >= 0 && order <= kMaxTransferOrder, "transfer: expected an order of 0 to 6");
    auto out = std::make_shared<MaskIntegrals>();
    out->order = order;
    const int pairs = (order + 1) * (order + 2) / 2;
    out->groups = (pairs + kLanes - 1) / kLanes;
    const std::size_t lanes = static_cast<std::size_t>(out->groups) * kLanes;
    out->fours.assign(static_cast<std::size_t>(size / 4) * 16 * lanes, 0);
    out->rowCos.assign(static_cast<std::size_t>(size) * lanes, 0);
    out->rowSin = out->rowCos;
    std::size_t pair = 0;
    for (int l = 0; l <= order; ++l)
        for (int m = 0; m <= l; ++m, ++pair) {
            std::vector<double> step(static_cast<std::size_t>(size));
            constexpr int kPoints = 16;  // midpoint rule within a step
            for (int k = 0; k < size; ++k)
                for (int q = 0; q < kPoints; ++q) {
                    const double u = (k + (q + 0.5) / kPoints) / size;
                    step[static_cast<std::size_t>(k)] += harmonicOfHeight(l, m, std::sqrt(1 - u)) / kPoints;
                }
            for (std::size_t four = 0; four < static_cast<std::size_t>(size / 4); ++four)
                for (std::size_t value = 0; value < 16; ++value) {
                    double sum = 0;
                    for (std::size_t bit = 0; bit < 4; ++bit)
                        if (value >> bit & 1) sum += step[four * 4 + bit];
                    out->fours[(four * 16 + value) * lanes + pair] =
                        static_cast<std::int16_t>(std::lround(sum * kIntegralScale));
                }
            const double half = m * kPi / size;
            const double overRow = (m > 0 ? std::sin(half) / half : 1.0) / (kIntegralScale * size * size);
            for (int r = 0; r < size; ++r) {
                const double phi = 2 * kPi * (r + 0.5) / size;
                out->rowCos[static_cast<std::size_t>(r) * lanes + pair] =
                    static_cast<float>(std::cos(m * phi) * overRow);
                out->rowSin[static_cast<std::size_t>(r) * lanes + pair] =
                    static_cast<float>(std::sin(m * phi) * overRow);
            }
        }
    return out;
}

}  // namespace nacre
