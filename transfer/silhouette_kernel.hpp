// Silhouettes into masks, by the widest vectors that the processor has: what a set of triangles hides, from the edges
// that only one of two blocking triangles has.
#pragma once

#include <span>

#include "transfer/mask_kernel.hpp"
#include "transfer/receiver_groups.hpp"

namespace nacre {

/// An edge in its place, from p to q as the triangle that it is named after has it.
struct alignas(32) EdgeRow {
    float p[3] = {}, spare = 0;
    float q[3] = {}, room = 0;
};

/// Sixteen triangles near each other, side by side; those that aren't used have no area.
struct TriangleCluster {
    alignas(64) float corners[9][kLanes];
    float normal[3][kLanes], offset[kLanes];  ///< of their planes: unit normals, outward, or 0
    float middle[3][kLanes], reach[kLanes];   ///< balls about them
    float centre[3] = {}, radius = 0;         ///< a ball about all
};

/// Sixteen receivers side by side. Those that aren't used repeat the first.
struct ReceiverLanes {
    alignas(64) float point[3][kLanes], normal[3][kLanes];
    float height[kLanes];  ///< of the points along the normals
    GroupBox box;          ///< about the points, or more
};
ReceiverLanes receiverLanes(std::span<const Receiver> receivers, const GroupBox& box);

/// What a cluster is for each of sixteen receivers, as bits: whether some of it may rise over the horizon, and whether
/// some may lie straight above.
struct ClusterFlags {
    std::uint32_t above, overhead;
};

/// What a cluster's triangles are to sixteen receivers.
struct ClusterFaces {
    std::uint32_t some;  ///< all words together
    bool alike;          ///< all sixteen are the same
};

/// A mask as counts of layers: for each row how many more layers are hidden from a step on, [step][row] with one step
/// below the horizon, and how many hide the pole. A direction is hidden where the sum from the pole is positive. Right
/// while fewer than 32768 edges' layers fall into one step of a row.
inline std::size_t layerCounts(int size) { return static_cast<std::size_t>(size) * static_cast<std::size_t>(size + 1); }

/// A point nearer to a triangle's plane [of the extent] touches it: on which side it is, rounding decides. The triangle
/// faces it where it is against the point's normal, as the ground is under what stands on it; of two faces that lie on
/// each other one does.
inline constexpr float kFacing = 1e-7f;
inline constexpr float kRounding = 2e-6f;  ///< of positions and planes, at most [of the extent]

/// A mesh's edges by the places of the triangles on their two sides; an edge runs along `a` as that stands and along
/// `b` reversed. Cluster c's own lie from inside[c] to between[c], those to others and bare ones, each at one of its
/// two clusters, from there to inside[c + 1]. All in sixteens: where there are fewer, a = b.
struct EdgeSides {
    std::vector<std::uint32_t> a, b;
    std::vector<std::uint32_t> inside;  ///< one more than clusters
    std::vector<std::uint32_t> between;
};

inline constexpr std::uint8_t kInside = 1, kBetween = 2;

/// Edges by the receivers for which their two sides differ, room for 15 more behind.
struct DifferingEdges {
    std::vector<std::uint32_t> edge, sides,
        first;  ///< sides: as bits; first: what the first triangle is, as face has it
    std::size_t count = 0;
    void resize(std::size_t edges);
};
/// Of each receiver the edges that bound what it doesn't see: 8 × the edge's number, and flags.
struct DealtEdges {
    static constexpr std::uint32_t kOther = 1;  ///< the layer lies on the edge's other side
    static constexpr std::uint32_t kTwice = 2;  ///< two layers do, where a back joins a front
    static constexpr std::uint32_t kUnder = 4;  ///< it lies under the edge, whichever side that is
    std::vector<std::uint32_t> items;           ///< [receiver][room]
    std::size_t room = 0;
    std::size_t counts[kLanes] = {};
};

/// Of each receiver the triangles that may lie over its pole: 2 × the place, + 1 where it's the back that is seen.
struct PoleTriangles {
    std::vector<std::uint32_t> items;  ///< [receiver][room]
    std::size_t room = 0;
    std::size_t counts[kLanes] = {};
};

struct SilhouetteKernel {
    /// A cluster where its points are now. \param triangles  sixteen; those from `count` on have no area
    void (*place)(const glm::vec3* points, const glm::uvec3* triangles, std::size_t count, TriangleCluster& out);
    ClusterFlags (*classify)(const TriangleCluster& cluster, const ReceiverLanes& receivers);
    /// Low sixteen bits of `out`: for which receivers the triangle faces; high ones: to which it turns its back. Of
    /// `seen`'s bits alone, without those of own[triangle], and of the triangles in `members`: the others' are 0.
    /// \param one  the box's middle's view stands for all receivers', none of which meets the cluster
    ClusterFaces (*face)(const TriangleCluster& cluster, const ReceiverLanes& receivers, bool one, std::uint32_t seen,
                         std::uint32_t members, const std::uint32_t* own, std::uint32_t* out);
    /// \param sides  [place] as face has it  \param look  [cluster] kInside and kBetween for edges that may differ
    void (*differ)(const EdgeSides& edges, const std::uint32_t* sides, const std::uint8_t* look, DifferingEdges& out);
    /// Adds the triangles that may lie over the poles of receivers. \param number  the cluster's \param which
    /// receivers, as bits \param faces  as face has it
    void (*nearPole)(const TriangleCluster& cluster, std::uint32_t number, const Receiver* receivers,
                     std::uint32_t which, const std::uint32_t* faces, PoleTriangles& out);
    /// How many layers of triangles hide the receiver's pole; less those that do with the other side than they are said
    /// to. \param items  as PoleTriangles has them, room for 15 more behind
    std::int32_t (*overhead)(const TriangleCluster* clusters, std::uint32_t* items, std::size_t count,
                             const Receiver& receiver);
    /// Adds the edges to the items of their receivers, where an end is over the receiver's horizon.
    void (*deal)(const EdgeRow* edges, const ReceiverLanes& receivers, const DifferingEdges& differing,
                 DealtEdges& out);
    /// Adds the layers that edges bound. \param items  as DealtEdges has them, room for 15 more behind
    void (*add)(const MaskRows& rows, const EdgeRow* edges, const Receiver& receiver, std::uint32_t* items,
                std::size_t count, std::int16_t* layers);
    /// \param mask  [(N + 31)/32][N] words, written
    void (*finish)(const std::int16_t* layers, std::int32_t pole, std::uint32_t* mask);
};

/// \param size  of the mask: 16, 32, 64 or 128 \throws std::invalid_argument also when the processor lacks the set
SilhouetteKernel silhouetteKernel(int size, VectorSet set = VectorSet::Widest);

}  // namespace nacre
