// What else a visibility mask is good for: glossy transfer for one view, and light integrated without harmonics.
#pragma once

#include <functional>
#include <span>

#include "core/math.hpp"
#include "transfer/harmonic_rotation.hpp"

namespace nacre {

/// f(wi, wo) [1/sr] for a bundle of directions to the light, in the local frame (z the normal).
/// \param wo  unit, to the viewer \param wi  unit, z ≥ 0 \param f  one value each
using BrdfOfDirections = std::function<void(const glm::vec3& wo, std::span<const glm::vec3> wi, std::span<float> f)>;

/// Phong's lobe (n + 2)/2π max(0, r·wi)^n about the mirrored view r: what it sends on is at most 1.
BrdfOfDirections phongBrdf(float exponent);

/// How finely a mask is read.
enum class MaskDetail {
    Blocks,  ///< 4 × 4 bits as one grey value (HEMI section 3.2, "Downsampling the Visibility Mask")
    Bits
};

/// Masks of one size read against functions of direction. Cells of equal cosine-weighted area: each weighs π/cells.
class MaskShading {
public:
    /// \param size  of the masks \param order  of the harmonics
    MaskShading(int size, int order, MaskDetail detail);

    /// V_i(v) = ∫ y_i V f max(0, n·s) ds for the view wo, HEMI equation 3, by cells' middles: in `world` [(order +
    /// 1)²]. What faces away from the viewer gets zeros. \param toEye  unit, world's axes
    void glossy(const Receiver& receiver, std::span<const std::uint32_t> mask, const glm::vec3& toEye,
                const BrdfOfDirections& brdf, std::span<float> world) const;

    /// ∫ y_i (1 − V) f max(0, n·s) ds, what a mask takes from an open hemisphere's transfer, in the mask's own frame.
    /// f is asked for cells alone that hide something. \param wo  unit, local \param local  [(order + 1)²]
    void hidden(std::span<const std::uint32_t> mask, const glm::vec3& wo, const BrdfOfDirections& brdf,
                std::span<float> local) const;

    /// ∫ L V max(0, n·s)/π ds: what a white diffuse point sends out, without harmonics.
    /// \param light  radiance by the world's direction
    Rgb direct(const Receiver& receiver, std::span<const std::uint32_t> mask,
               const std::function<Rgb(const Vec3&)>& light) const;

    std::size_t cells() const { return directions_.size(); }

private:
    float open(std::span<const std::uint32_t> mask, std::size_t cell) const;

    int size_, order_, block_;
    HarmonicRotation rotation_;
    std::vector<glm::vec3> directions_;  ///< [cell] unit, local
    std::vector<float> harmonics_;       ///< [cell][(order + 1)²] mean over the cell
};

}  // namespace nacre
