#include "envmaps/sphere_transform.hpp"

#include <complex>
#include <unsupported/Eigen/FFT>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "envmaps/legendre.hpp"
#include "envmaps/sphere_window.hpp"

namespace nacre {
namespace {

using Complex = std::complex<double>;
using Fft = Eigen::FFT<double>;

/// Four functions' coefficients of one m on one ring (or of one torus frequency).
struct RingValue {
    Vec4 re{0}, im{0};
};

/// Rings [m][ring], m = 0…order.
struct RingSpectra {
    int order = 0, rings = 0;
    std::vector<RingValue> values;
    RingSpectra(int theOrder, int theRings)
        : order(theOrder), rings(theRings), values(static_cast<std::size_t>(order + 1) * rings) {}
    RingValue* of(int m) { return &values[static_cast<std::size_t>(m) * rings]; }
    const RingValue* of(int m) const { return &values[static_cast<std::size_t>(m) * rings]; }
};

std::size_t blocksOf(std::size_t count, std::size_t block) { return (count + block - 1) / block; }
constexpr std::size_t kBlock = 16;  // rings or orders a task: one FFT plan serves them all

Fft makeFft() {
    Fft fft;
    fft.SetFlag(Fft::Unscaled);
    return fft;
}

/// 1/(lines' window transform) for k = 0…order.
std::vector<double> inverseTransform(const SphereWindow& window, int order, int lines) {
    std::vector<double> out(static_cast<std::size_t>(order) + 1);
    for (int k = 0; k <= order; ++k) out[k] = 1 / window.transform(k, lines);
    return out;
}

/// Rows of the grid to their frequencies m, the window divided out. Two real functions go through one transform.
RingSpectra spectraOfRows(const SphereGrid& grid, const SphereWindow& window, int order, unsigned threads) {
    RingSpectra out(order, grid.rows);
    const std::vector<double> inverse = inverseTransform(window, order, grid.columns);
    parallelFor(blocksOf(grid.rows, kBlock), threads, [&](std::size_t block) {
        Fft fft = makeFft();
        std::vector<Complex> in(grid.columns), pair[2];
        const int last = std::min<int>(grid.rows, static_cast<int>((block + 1) * kBlock));
        for (int row = static_cast<int>(block * kBlock); row < last; ++row) {
            const Vec4* line = &grid.values[static_cast<std::size_t>(row) * grid.columns];
            for (int p = 0; p < 2; ++p) {
                for (int n = 0; n < grid.columns; ++n) in[n] = {line[n][2 * p], line[n][2 * p + 1]};
                pair[p].resize(in.size());
                fft.fwd(pair[p].data(), in.data(), grid.columns);
            }
            for (int m = 0; m <= order; ++m) {
                RingValue& value = out.of(m)[row];
                for (int p = 0; p < 2; ++p) {
                    const Complex z = pair[p][m], mirrored = std::conj(pair[p][m == 0 ? 0 : grid.columns - m]);
                    const Complex first = 0.5 * inverse[m] * (z + mirrored);
                    const Complex second = Complex(0, -0.5 * inverse[m]) * (z - mirrored);
                    value.re[2 * p] = first.real();
                    value.im[2 * p] = first.imag();
                    value.re[2 * p + 1] = second.real();
                    value.im[2 * p + 1] = second.imag();
                }
            }
        }
    });
    return out;
}

/// The inverse of spectraOfRows: a real row is S_0 + 2 Re Σ S_m e^{imφ}.
void rowsOfSpectra(const RingSpectra& spectra, const SphereWindow& window, SphereGrid& grid, unsigned threads) {
    const int order = spectra.order;
    const std::vector<double> inverse = inverseTransform(window, order, grid.columns);
    parallelFor(blocksOf(grid.rows, kBlock), threads, [&](std::size_t block) {
        Fft fft = makeFft();
        std::vector<Complex> spectrum(grid.columns), line(grid.columns);
        const int last = std::min<int>(grid.rows, static_cast<int>((block + 1) * kBlock));
        for (int row = static_cast<int>(block * kBlock); row < last; ++row)
            for (int p = 0; p < 2; ++p) {
                std::fill(spectrum.begin(), spectrum.end(), Complex(0));
                for (int m = 0; m <= order; ++m) {
                    const RingValue& value = spectra.of(m)[row];
                    const Complex first(value.re[2 * p], value.im[2 * p]);
                    const Complex second(value.re[2 * p + 1], value.im[2 * p + 1]);
                    spectrum[m] = inverse[m] * (first + Complex(0, 1) * second);
                    if (m > 0)
                        spectrum[grid.columns - m] =
                            inverse[m] * (std::conj(first) + Complex(0, 1) * std::conj(second));
                }
                fft.inv(line.data(), spectrum.data(), grid.columns);
                Vec4* out = &grid.values[static_cast<std::size_t>(row) * grid.columns];
                for (int n = 0; n < grid.columns; ++n) {
                    out[n][2 * p] = line[n].real();
                    out[n][2 * p + 1] = line[n].imag();
                }
            }
    });
}

/// From one set of rings to another, for every m: around the torus θ ∈ [0, 2π), where ring −θ is ring θ times (−1)^m.
/// Frequencies up to the order pass, each times factor[|k|].
RingSpectra changeRings(const RingSpectra& in, int rings, const std::vector<double>& factor, unsigned threads) {
    RingSpectra out(in.order, rings);
    const int from = 2 * in.rings, to = 2 * rings;
    // Rings lie at (j + ½)·2π/lines: half a step of phase on either side.
    std::vector<Complex> shift(static_cast<std::size_t>(in.order) + 1);
    for (int k = 0; k <= in.order; ++k) shift[k] = std::polar(factor[k], kPi * k * (1.0 / to - 1.0 / from));
    parallelFor(blocksOf(in.order + 1, kBlock), threads, [&](std::size_t block) {
        Fft fft = makeFft();
        std::vector<Complex> line(from), frequencies(from), spectrum(to), back(to);
        const int last = std::min<int>(in.order + 1, static_cast<int>((block + 1) * kBlock));
        for (int m = static_cast<int>(block * kBlock); m < last; ++m)
            for (int c = 0; c < 4; ++c) {
                const RingValue* values = in.of(m);
                const double parity = m % 2 ? -1 : 1;
                for (int j = 0; j < in.rings; ++j) {
                    line[j] = {values[j].re[c], values[j].im[c]};
                    line[from - 1 - j] = parity * line[j];
                }
                fft.fwd(frequencies.data(), line.data(), from);
                std::fill(spectrum.begin(), spectrum.end(), Complex(0));
                spectrum[0] = shift[0] * frequencies[0];
                for (int k = 1; k <= in.order; ++k) {
                    spectrum[k] = shift[k] * frequencies[k];
                    spectrum[to - k] = std::conj(shift[k]) * frequencies[from - k];
                }
                fft.inv(back.data(), spectrum.data(), to);
                RingValue* result = out.of(m);
                for (int j = 0; j < rings; ++j) {
                    result[j].re[c] = back[j].real();
                    result[j].im[c] = back[j].imag();
                }
            }
    });
    return out;
}

/// The northern half of `rings` rings (the southern mirrors it).
struct NorthernRings {
    std::vector<double> cosines, sines;
    explicit NorthernRings(int rings) {
        for (int q = 0; q < rings / 2; ++q) {
            cosines.push_back(std::cos(kPi * (q + 0.5) / rings));
            sines.push_back(std::sin(kPi * (q + 0.5) / rings));
        }
    }
};

int legendreRings(int order) { return fastLength(order + 1); }

void checkOrder(int order) {
    require(order >= 0 && order <= kMaxHarmonicOrder, "sphere transform: order must be 0 to 1500");
}

}  // namespace

Harmonics::Harmonics(int order) : order_(order) {
    checkOrder(order);
    values_.resize(static_cast<std::size_t>(order + 1) * (order + 2) / 2);
}

// With F_m(θ_q) the transposed interpolation of the points onto rings θ_q, a_lm = Σ_q P̄_lm(cosθ_q) F_m(θ_q): the
// transpose of synthesis, so there are no quadrature weights and no sampling error.
Harmonics analyseHarmonics(std::span<const SpherePoint> points, int order, unsigned threads) {
    checkOrder(order);
    const SphereWindow& window = sphereWindow();
    SphereGrid grid = makeSphereGrid(order);
    spreadPoints(points, window, grid, threads);
    RingSpectra onGrid = spectraOfRows(grid, window, order, threads);
    grid.values = {};
    const int rings = legendreRings(order);
    std::vector<double> factor = inverseTransform(window, order, 2 * onGrid.rings);
    for (double& f : factor) f /= 2.0 * rings;
    const RingSpectra onRings = changeRings(onGrid, rings, factor, threads);

    Harmonics out(order);
    const NorthernRings north(rings);
    parallelFor(static_cast<std::size_t>(order) + 1, threads, [&](std::size_t task) {
        const int m = static_cast<int>(task);
        const RingValue* f = onRings.of(m);
        std::vector<RingValue> halves[2];  // even and odd l − m
        for (int q = 0; q < rings / 2; ++q) {
            const RingValue &a = f[q], &b = f[rings - 1 - q];
            halves[0].push_back({a.re + b.re, a.im + b.im});
            halves[1].push_back({a.re - b.re, a.im - b.im});
        }
        LegendreColumn column(m, north.cosines, north.sines);
        for (int l = m; l <= order; ++l, column.next()) {
            const std::vector<double>& p = column.values();
            const std::vector<RingValue>& half = halves[(l - m) % 2];
            RingValue sum;
            for (std::size_t q = 0; q < p.size(); ++q) {
                sum.re += p[q] * half[q].re;
                sum.im += p[q] * half[q].im;
            }
            out.at(l, m) = {sum.re, sum.im};
        }
    });
    return out;
}

std::vector<Vec4> synthesiseHarmonics(const Harmonics& harmonics, std::span<const Vec3> directions, unsigned threads) {
    const int order = harmonics.order(), rings = legendreRings(order);
    const NorthernRings north(rings);
    RingSpectra onRings(order, rings);
    parallelFor(static_cast<std::size_t>(order) + 1, threads, [&](std::size_t task) {
        const int m = static_cast<int>(task);
        std::vector<RingValue> halves[2] = {std::vector<RingValue>(rings / 2), std::vector<RingValue>(rings / 2)};
        LegendreColumn column(m, north.cosines, north.sines);
        for (int l = m; l <= order; ++l, column.next()) {
            const std::vector<double>& p = column.values();
            std::vector<RingValue>& half = halves[(l - m) % 2];
            const Harmonics::Value& a = harmonics.at(l, m);
            for (std::size_t q = 0; q < p.size(); ++q) {
                half[q].re += p[q] * a.re;
                half[q].im += p[q] * a.im;
            }
        }
        RingValue* out = onRings.of(m);
        for (int q = 0; q < rings / 2; ++q) {
            const RingValue &even = halves[0][q], &odd = halves[1][q];
            out[q] = {even.re + odd.re, even.im + odd.im};
            out[rings - 1 - q] = {even.re - odd.re, even.im - odd.im};
        }
    });
    const SphereWindow& window = sphereWindow();
    SphereGrid grid = makeSphereGrid(order);
    std::vector<double> factor = inverseTransform(window, order, 2 * grid.rows);
    for (double& f : factor) f /= 2.0 * rings;
    rowsOfSpectra(changeRings(onRings, grid.rows, factor, threads), window, grid, threads);
    return gatherPoints(grid, window, directions, threads);
}

}  // namespace nacre
