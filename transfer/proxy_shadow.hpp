// Shadows that objects cast on each other: a coarse stand-in of the one is projected onto the light of the other (HEMI
// section 4.1), so that each object's own transfer stays what it is.
#pragma once

#include "transfer/blocker_levels.hpp"
#include "transfer/exitant_radiance.hpp"

namespace nacre {

/// An object that casts: its coarsest level of detail, which follows its motion.
class ShadowProxy {
public:
    /// \param rest  finite positions by which the level is made \param triangles  of it, about so many; 0: the mesh
    ShadowProxy(const WeldedMesh& mesh, std::span<const glm::vec3> rest, std::size_t triangles = 200);

    /// \param positions  finite, of the welded vertices
    void move(std::span<const glm::vec3> positions);

    std::span<const BlockerRow> blockers() const { return blockers_; }  ///< none before the first move()
    Vec3 centre() const { return centre_; }

private:
    BlockerLevels::Level level_;
    CornersOfVertices corners_;
    std::vector<BlockerRow> blockers_;
    Vec3 centre_{0};
};

/// The light's coefficients L_i − ∫ y_i L hidden, what is hidden by two masks that look at each proxy and away from it.
/// Light is taken as its coefficients say, and the product is cut at their order again.
class LightProjector {
public:
    /// \param order  of the light \param mask  bits a side, 16, 32, 64 or 128 \throws std::invalid_argument
    explicit LightProjector(int order, int mask = 32);

    /// \param at  from where proxies are seen \throws std::invalid_argument for light of another order
    LightCoefficients shadowed(const LightCoefficients& light, const Vec3& at,
                               std::span<const ShadowProxy* const> proxies) const;

private:
    void drawInto(std::vector<std::uint32_t>& mask, const Receiver& receiver, const ShadowProxy& proxy) const;
    void addHidden(LightCoefficients& hidden, const LightCoefficients& light, const Receiver& receiver,
                   std::span<const std::uint32_t> mask) const;

    HarmonicRotation rotation_;
    int mask_;
    std::vector<float> harmonics_;     ///< [row][step][(order + 1)²], local
    std::vector<double> solidAngles_;  ///< [step]
};

/// Light at points within a receiver's box: the middles of x × y × z equal cells, between which it is linear.
struct LightGrid {
    Vec3 low{0}, high{0};
    glm::ivec3 cells{1};                      ///< 1 × 1 × 1: one light for the whole object, as HEMI has it
    std::vector<LightCoefficients> lights{};  ///< x fastest

    LightCoefficients at(const Vec3& point) const;
};

/// \param positions  of the receiver \param cells  ≥ 1 each \throws std::invalid_argument
LightGrid shadowedLights(const LightProjector& projector, const LightCoefficients& light,
                         std::span<const glm::vec3> positions, const glm::ivec3& cells,
                         std::span<const ShadowProxy* const> proxies, unsigned threads = 0);

/// exitantRadiance with each vertex in the grid's light where it is.
std::vector<glm::vec3> exitantRadiance(std::span<const float> transfer, std::span<const glm::vec3> positions,
                                       const LightGrid& grid, const Rgb& albedo = Rgb(1), unsigned threads = 0);

}  // namespace nacre
