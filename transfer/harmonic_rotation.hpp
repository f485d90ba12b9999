// Coefficients of spherical harmonics turned from a vertex's frame into the world's, many vertices at once.
#pragma once

#include <vector>

#include "transfer/mask_kernel.hpp"

namespace nacre {

/// A band-limited function on band l is Σ_j z_j Σ_m y_lm(d_j) y_lm(s) for fixed directions d_j: turning it turns the
/// directions. 2 order + 1 directions serve all bands; `weights` give z from coefficients (the pseudo-inverse, chosen
/// well-conditioned).
class HarmonicRotation {
public:
    /// \param order  0 to kMaxTransferOrder
    explicit HarmonicRotation(int order);

    /// f'(R s) = f(s), R's columns tangent, bitangent, normal; float, 1e-6 of the largest coefficient.
    /// \param local  [(order + 1)²][16] in the frame of receivers[lane], in envmaps' order l² + l + m
    /// \param count  receivers, 1 to 16 \param world  [count][(order + 1)²]
    void turn(const Receiver* receivers, std::size_t count, const float* local, float* world) const;

    int order() const { return order_; }

private:
    int order_;
    std::vector<float> scales_;      ///< of y_lm
    std::vector<float> directions_;  ///< [3] a direction
    std::vector<float> weights_;     ///< [coefficient l² + l + m][direction]
};

}  // namespace nacre
