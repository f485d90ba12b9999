// Transfer of glossy surfaces for one viewer, from the masks of diffuse transfer (HEMI equation 3).
#pragma once

#include "transfer/mask_shading.hpp"
#include "transfer/self_transfer.hpp"

namespace nacre {

/// V_i(wo) = ∫ y_i V f max(0, n·s) ds of an isotropic BRDF. As in SelfTransfer what is hidden is taken from the open
/// hemisphere's transfer, which a table by the viewer's elevation has: only what a mask hides has the cells' error.
class GlossyTransfer {
public:
    /// The table takes 129 elevations and 256 × 128 directions: right to 1e-3 for lobes as wide as an exponent of 1000.
    /// \param size  of the masks \param order  of the harmonics \param detail  how finely masks are read
    /// \throws std::invalid_argument for sizes that no mask has
    GlossyTransfer(int size, int order, MaskDetail detail, BrdfOfDirections brdf);

    /// \param toEye  unit, world's axes; zeros for what faces away \param world  [(order + 1)²]
    void transfer(const Receiver& receiver, std::span<const std::uint32_t> mask, const glm::vec3& toEye,
                  std::span<float> world) const;

private:
    void addOpen(float cosine, std::span<float> local) const;

    MaskShading masks_;
    int order_;
    HarmonicRotation rotation_;
    BrdfOfDirections brdf_;
    std::vector<float> open_;  ///< [elevation][(order + 1)²], the viewer in the plane of x and z
};

/// A frame's diffuse transfer and that of lobes, from the same masks.
struct GlossyFrame {
    TransferFrame diffuse;
    std::vector<std::vector<float>> lobes;  ///< [lobe][vertex][(order + 1)²]; zeros where a vertex faces away
};

/// \param lobes  made for the masks and the order of `transfer` \param eye  where the viewer stands
/// \throws std::invalid_argument as SelfTransfer::compute; when the eye isn't finite
GlossyFrame computeLobes(const SelfTransfer& transfer, std::span<const glm::vec3> positions,
                         std::span<const GlossyTransfer* const> lobes, const Vec3& eye,
                         std::span<const std::uint8_t> wanted = {});

/// V = (1 − specular) V of f = 1/π + specular V of the lobe, in a frame's place for V.
/// \throws std::invalid_argument as computeLobes; when `specular` isn't in [0, 1]
TransferFrame computeGlossy(const SelfTransfer& transfer, std::span<const glm::vec3> positions,
                            const GlossyTransfer& lobe, double specular, const Vec3& eye,
                            std::span<const std::uint8_t> wanted = {});

}  // namespace nacre
