// Visibility of a hemisphere in N × N bits, in polar layout: the tables that the kernels read.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace nacre {

inline constexpr int kMaxMaskSize = 128;     ///< rows and steps of the largest mask
inline constexpr int kMaxTransferOrder = 6;  ///< highest band of spherical harmonics
inline constexpr int kLanes = 16;            ///< rows that the kernels handle together

/// A mask is the unit disk of HEMI section 3.1 (the hemisphere with z dropped: bits of equal area weigh the cosine) in
/// polar coordinates: row r is the azimuth φ_r = 2π (r + ½)/N, bit k of a row the step u = sin²θ in [k, k + 1)/N. Along
/// a row the plane n·s ≥ 0 is one threshold: with nz ≠ 0 and q = −(nx cosφ + ny sinφ)/nz it says cotθ ≥ q (nz > 0) or
/// cotθ ≤ q (nz < 0), and u = 1/(1 + cot²θ). A triangle is three planes: one interval of bits a row.
///
/// Within its step a row looks at an offset of its own, dither[r] in (0, 1): thresholds that run along rows, as a
/// floor's horizon does, are then right on average where they would all round the same way.
struct MaskRows {
    alignas(64) float cosPhi[kMaxMaskSize];
    alignas(64) float sinPhi[kMaxMaskSize];
    alignas(64) float dither[kMaxMaskSize];
    float tangents[kMaxMaskSize / 8];  ///< of the first eighth's azimuths
    /// Sixteen rows from row w on, each in the lane that its row has in its block of sixteen; `inBlock[w][b]` has ones
    /// in the lanes whose row lies in block b.
    struct Window {
        alignas(64) float cosPhi[kLanes], sinPhi[kLanes], dither[kLanes];
        alignas(64) std::uint32_t inBlock[kMaxMaskSize / kLanes][kLanes];
    };
    std::vector<Window> windows;  ///< one a row
    /// Eight rows from row w on, each in the lane of its row modulo eight; `inBlock` is for them twice side by side.
    struct HalfWindow {
        alignas(32) float cosPhi[kLanes / 2], sinPhi[kLanes / 2], dither[kLanes / 2];
        alignas(64) std::uint32_t inBlock[kMaxMaskSize / kLanes][kLanes];
    };
    std::vector<HalfWindow> halves;  ///< one a row
};

/// What a mask's bits integrate to: for each row Σ over set bits of the mean of K_lm P_lm over the bit's step, by four
/// bits, and the mean of cos mφ and sin mφ over the row's azimuths.
struct MaskIntegrals {
    int order = 4;
    int groups = 1;                     ///< of 16 pairs (l, m ≥ 0): pair l(l + 1)/2 + m
    std::vector<std::int16_t> fours;    ///< [N/4][16][16 groups], times kIntegralScale: few, they stay in the cache
    std::vector<float> rowCos, rowSin;  ///< [N][16 groups], divided by kIntegralScale and N²
};
inline constexpr double kIntegralScale = 512;  ///< 32 bits of one row stay below 32768

/// \param size  N: 16, 32, 64 or 128 \throws std::invalid_argument
std::shared_ptr<const MaskRows> maskRows(int size);
/// \param order  0 to kMaxTransferOrder
std::shared_ptr<const MaskIntegrals> maskIntegrals(int size, int order);

/// Transfer of a point that nothing shadows, diffuse with f = 1/π, about its normal: the zonal coefficients
/// U_l = ∫ y_l0(s) max(0, cosθ)/π ds, l ≤ order.
std::vector<double> openTransfer(int order);

/// K_lm P_lm(x), m ≥ 0, of orthonormal real harmonics without the phase (−1)^m: y_lm = √2^{m > 0} K_lm P_lm cos mφ, …
double harmonicOfHeight(int l, int m, double x);
/// y_lm of the direction at height z and azimuth phi, −l ≤ m ≤ l.
double harmonicAt(int l, int m, double z, double phi);

}  // namespace nacre
