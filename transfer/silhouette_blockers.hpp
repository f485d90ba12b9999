// What blocks a moving mesh's vertices as silhouettes: edges of which one triangle blocks and the other doesn't.
#pragma once

#include <span>

#include "transfer/memory.hpp"
#include "transfer/silhouette_kernel.hpp"

namespace nacre {

/// Which receivers see backs of a triangle block.
enum class BackSides : std::uint8_t { None, Inside, All };

/// Triangles of all levels of a mesh, in clusters of one level, and their edges by the clusters on their two sides.
/// Triangles of one level share edges; what hides is the union of those that are listed, of whatever levels.
class SilhouetteMesh {
public:
    struct Frame {
        std::vector<TriangleCluster> clusters;
        std::vector<EdgeRow> edges;
        std::size_t bytes() const { return bytesOf(clusters) + bytesOf(edges); }
    };
    /// Some triangles of a cluster, as bits.
    struct Part {
        std::uint32_t cluster = 0, triangles = 0;
    };
    /// What a group of up to sixteen receivers sees.
    struct Seen {
        std::vector<std::uint32_t> members;  ///< [cluster] the triangles that are listed, as bits: see's input
        std::vector<std::uint8_t> look;      ///< [cluster] as SilhouetteKernel::differ has it
        std::vector<std::uint8_t> seen;      ///< [cluster] whether some of its sides may not be 0
        std::vector<std::uint32_t> own;      ///< [place] receivers that the triangle meets
        std::vector<std::uint32_t> sides;    ///< [cluster][16] as SilhouetteKernel::face; one more, of what isn't there
        PoleTriangles nearPole;
        DifferingEdges differing;
        DealtEdges dealt;
        std::int32_t poles[kLanes] = {};
        /// The cluster's triangles, as bits, that block for some receiver.
        std::uint32_t blocking(std::size_t cluster) const;
    };

    SilhouetteMesh() = default;
    /// \param levels  triangles by the numbers of points  \param points  at rest, by which clusters are made
    /// \param backs  [level][triangle]  \param patches  [level][triangle] of neighbours in space, whose triangles are
    /// listed together; empty: any may be
    SilhouetteMesh(std::span<const std::vector<glm::uvec3>> levels, std::span<const glm::vec3> points,
                   std::span<const std::vector<BackSides>> backs,
                   std::span<const std::vector<std::uint32_t>> patches = {});

    /// The parts of clusters that some triangles of a level are.
    std::vector<Part> partsOf(std::size_t level, std::span<const std::uint32_t> triangles) const;

    /// \param points  of a frame, with an extent of 1
    void place(std::span<const glm::vec3> points, const SilhouetteKernel& kernel, unsigned threads, Frame& out) const;

    /// The edges that bound what out.members hide from each receiver.
    /// \param box  about the receivers, or more \param corners  [receiver][] of the triangles of level 0 that meet
    /// there, 3 × triangle + corner \param inside  bits of the receivers that see Inside backs \param nearby  triangles
    /// of clusters farther from the box's middle than so many of its radii show all receivers the side that they show
    /// the middle; infinity: none do. What is taken for the wrong side is seen nearly edge-on, and counts against its
    /// neighbours: what they hide together moves by an error of second order
    void see(const Frame& frame, const SilhouetteKernel& kernel, std::span<const Receiver> receivers,
             const GroupBox& box, std::span<const std::span<const std::uint32_t>> corners, std::uint32_t inside,
             float nearby, Seen& out) const;

    std::size_t clusterCount() const { return clusters_.size(); }
    /// All of a cluster's triangles.
    std::uint32_t all(std::size_t cluster) const { return (1u << clusters_[cluster].count) - 1; }
    std::size_t bytes() const;

private:
    struct Cluster {
        std::uint32_t count = 0;  ///< triangles
        BackSides backs = BackSides::None;
    };
    void addCluster(std::size_t level, const std::vector<glm::uvec3>& triangles, std::span<const std::uint32_t> some,
                    BackSides backs);
    void joinEdges();

    std::vector<glm::uvec3> triangles_;  ///< [cluster][16]
    std::vector<Cluster> clusters_;
    std::vector<std::vector<std::uint32_t>> slots_;  ///< [level][triangle] its place in triangles_
    std::vector<glm::uvec2> ends_;                   ///< [edge] points
    EdgeSides edges_;
    std::vector<std::vector<std::uint32_t>> borders_;  ///< [cluster] clusters at which its edges to others lie
    std::vector<glm::uvec3> edgesOf_;                  ///< [place] of a triangle's corners c and c + 1
};

}  // namespace nacre
