// Soft self-shadows of a moving mesh: for each vertex and frame the light transfer, without precomputation (HEMI).
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "transfer/blocker_levels.hpp"
#include "transfer/blocking_parts.hpp"
#include "transfer/harmonic_rotation.hpp"

namespace nacre {

inline constexpr std::size_t kUsualCoarse = 500;  ///< SelfTransferOptions::coarse of who wants levels
/// For an error of 2 to 3 % levels are 1.3 times as fast at 6000 triangles, twice at 15000, eight times at 100000.
inline constexpr std::size_t usualCoarse(std::size_t triangles) { return triangles > 20000 ? kUsualCoarse : 0; }

/// Errors by sharing silhouettes stay within a tenth of those by the mask's bits.
inline constexpr double usualNearby(int mask) { return mask / 16.0; }

struct SelfTransferOptions {
    int mask = 32;  ///< N of N × N bits: 16, 32, 64, 128
    int order = 4;  ///< highest band of harmonics, 0 to 6: (order + 1)² coefficients
    /// Triangles of the coarsest level, about; 0 = no levels, the mesh itself everywhere; none = usualCoarse's.
    std::optional<std::size_t> coarse{};
    int rings = 1;  ///< with levels, the mesh itself blocks within so many rings of triangles: 1 or 2
    /// [rad] A level is used where it is off by less, seen from the vertex; by kFineAngle of that where it is dark.
    double lodAngle = 0.25;
    /// Vertices whose transfer is off by no more, relative to itself, at rest and in the poses, see the coarsest level
    /// everywhere but near themselves. 0 = none do.
    double lodError = 0.05;
    /// Sixteen vertices near each other see the same side of what is farther from them than so many of their group's
    /// radii, that which its middle sees: their silhouettes there are found once. 0 = each its own; none =
    /// usualNearby's.
    std::optional<double> nearby{};
    BlockingSides sides = BlockingSides::Auto;
    VectorSet vectors = VectorSet::Widest;
    unsigned threads = 0;
};

/// Seconds of all threads together. Transform: positions, levels, lists and what culls them (HEMI table 2).
struct TransferSeconds {
    double rasterization = 0, integration = 0, transform = 0, other = 0;
};

struct TransferFrame {
    std::vector<float> coefficients;  ///< [vertex][(order + 1)²], world's axes, index l² + l + m; see SelfTransfer
    std::vector<glm::vec3> normals;   ///< unit; 0 where a vertex has none
    double listed = 0, drawn = 0;     ///< a computed vertex: triangles that may block, edges of silhouettes drawn
    std::size_t computed = 0;         ///< vertices
    TransferSeconds seconds;
};

/// Transfer vectors of a mesh whose topology stays: V_i = ∫ y_i(s) V(s) max(0, n·s)/π ds, HEMI equation 3 with the
/// diffuse f = 1/π (radiance = albedo Σ L_i V_i for radiance coefficients L_i). What is integrated is the share hidden,
/// taken from the transfer of an open hemisphere, which is known exactly.
///
/// What is drawn are silhouettes (silhouette_blockers.hpp). The triangles at a vertex hide what lies below them: all
/// that is under their far edges, down to the direction −n. With levels, further blockers come from the level of detail
/// that is close enough.
class SelfTransfer {
public:
    /// \param rest  positions of a frame by which levels of detail and groups of vertices are made; finite
    /// \throws std::invalid_argument for options out of range
    /// \param poses  of the motion, by which too it is found for which vertices the coarsest level does
    SelfTransfer(WeldedMesh mesh, std::span<const glm::vec3> rest, const SelfTransferOptions& options,
                 std::span<const std::vector<glm::vec3>> poses = {});
    ~SelfTransfer();
    SelfTransfer(SelfTransfer&&) noexcept;

    /// Called once for each computed vertex, from any thread: its mask of hidden directions and where that stands (its
    /// point is relative to the frame's extent).
    using MaskUse = std::function<void(std::uint32_t vertex, const Receiver&, std::span<const std::uint32_t> mask)>;

    /// Bits [group][⌈places/64⌉] of triangles, for visible_sets.hpp.
    struct BlockerSets {
        std::span<const std::uint64_t> visible;  ///< others aren't listed; empty = all are
        std::span<std::uint64_t> drawn;          ///< those that are drawn are added; empty = not asked
    };

    /// \param positions  of the welded vertices \param wanted  one a vertex, 0 = leave out; empty = all
    /// \throws std::invalid_argument when one isn't finite
    TransferFrame compute(std::span<const glm::vec3> positions, std::span<const std::uint8_t> wanted = {},
                          const MaskUse& use = {}, const BlockerSets& sets = {}) const;

    const WeldedMesh& mesh() const;
    const SelfTransferOptions& options() const;  ///< resolved: Auto sides as most of the mesh has them
    std::size_t coarseTriangles() const;
    std::uint32_t groupCount() const, placeCount() const;
    /// Kept beside the tables that all meshes share: the mesh, its levels and groups, the room of a frame (once one has
    /// been computed) and its coefficients.
    std::size_t bytes() const;
    std::uint64_t key() const;  ///< differs where sets of blockers mean something else: by mesh, rest and levels

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nacre
