#include "transfer/silhouette_blockers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "core/parallel.hpp"

namespace nacre {
namespace {

struct HalfEdge {
    std::uint32_t slot;
    int corner;
    bool forwards;  ///< from the lower point to the higher
};

}  // namespace

void SilhouetteMesh::addCluster(std::size_t level, const std::vector<glm::uvec3>& triangles,
                                std::span<const std::uint32_t> some, BackSides backs) {
    for (const std::uint32_t t : some) {
        slots_[level][t] = static_cast<std::uint32_t>(triangles_.size());
        triangles_.push_back(triangles[t]);
    }
    clusters_.push_back({static_cast<std::uint32_t>(some.size()), backs});
    triangles_.resize(kLanes * clusters_.size(), glm::uvec3(triangles_.back().x));
}

SilhouetteMesh::SilhouetteMesh(std::span<const std::vector<glm::uvec3>> levels, std::span<const glm::vec3> points,
                               std::span<const std::vector<BackSides>> backs,
                               std::span<const std::vector<std::uint32_t>> patches) {
    for (std::size_t l = 0; l < levels.size(); ++l) {
        std::vector<glm::vec3> middles, normals;
        for (const glm::uvec3& t : levels[l]) {
            const glm::vec3 n = glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
            middles.push_back((points[t.x] + points[t.y] + points[t.z]) / 3.0f);
            normals.push_back(glm::dot(n, n) > 0 ? glm::normalize(n) : glm::vec3(0, 0, 1));
        }
        slots_.emplace_back(levels[l].size());
        for (const BackSides kind : {BackSides::None, BackSides::Inside, BackSides::All}) {
            std::vector<glm::vec3> ofKind = normals;
            std::vector<std::uint32_t> some;
            for (std::uint32_t t = 0; t < ofKind.size(); ++t)
                if (backs[l][t] == kind)
                    some.push_back(t);
                else
                    ofKind[t] = glm::vec3(0);
            if (patches.empty()) {
                for (const std::vector<std::uint32_t>& group : groupReceivers(middles, ofKind, kLanes))
                    addCluster(l, levels[l], group, kind);
                continue;
            }
            std::stable_sort(some.begin(), some.end(),
                             [&](std::uint32_t x, std::uint32_t y) { return patches[l][x] < patches[l][y]; });
            for (std::size_t i = 0; i < some.size(); i += kLanes)
                addCluster(l, levels[l], std::span(some).subspan(i, std::min<std::size_t>(kLanes, some.size() - i)),
                           kind);
        }
    }
    joinEdges();
}

void SilhouetteMesh::joinEdges() {
    const auto none = static_cast<std::uint32_t>(triangles_.size());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<HalfEdge>> halves;  // levels share no edges
    for (std::uint32_t slot = 0; slot < none; ++slot)
        for (int c = 0; slot % kLanes < clusters_[slot / kLanes].count && c < 3; ++c) {
            const std::uint32_t p = triangles_[slot][c], q = triangles_[slot][(c + 1) % 3];
            halves[std::minmax(p, q)].push_back({slot, c, p < q});
        }
    struct Edge {
        glm::uvec2 ends;
        HalfEdge a, b;
        std::uint32_t cluster() const { return a.slot / kLanes; }
        bool inside() const { return b.slot / kLanes == cluster(); }
    };
    std::vector<Edge> edges;
    for (auto& [ends, of] : halves)
        while (!of.empty()) {
            const HalfEdge a = of.back();
            of.pop_back();
            const auto b =
                std::find_if(of.begin(), of.end(), [&](const HalfEdge& h) { return h.forwards != a.forwards; });
            Edge edge{{ends.first, ends.second}, a, {none, 0, false}};
            if (!a.forwards) std::swap(edge.ends.x, edge.ends.y);
            if (b != of.end()) {
                edge.b = *b;
                of.erase(b);
            }
            edges.push_back(edge);
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
        return std::tuple(x.cluster(), !x.inside(), x.a.slot, x.a.corner) <
               std::tuple(y.cluster(), !y.inside(), y.a.slot, y.a.corner);
    });
    edgesOf_.assign(none, glm::uvec3(0));
    borders_.resize(clusters_.size());
    auto next = edges.begin();
    const auto take = [&](std::uint32_t cluster, bool inside) {
        const auto first = static_cast<std::uint32_t>(ends_.size());
        for (; next != edges.end() && next->cluster() == cluster && next->inside() == inside; ++next) {
            const auto i = static_cast<std::uint32_t>(ends_.size());
            edgesOf_[next->a.slot][next->a.corner] = i;
            if (next->b.slot != none) {
                edgesOf_[next->b.slot][next->b.corner] = i;
                if (!inside) borders_[next->b.slot / kLanes].push_back(cluster);
            }
            ends_.push_back(next->ends);
            edges_.a.push_back(next->a.slot);
            edges_.b.push_back(next->b.slot);
        }
        while (ends_.size() % kLanes) {
            ends_.emplace_back(0, 0);
            edges_.a.push_back(none);
            edges_.b.push_back(none);
        }
        return first;
    };
    for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
        edges_.inside.push_back(take(c, true));
        edges_.between.push_back(take(c, false));
    }
    edges_.inside.push_back(static_cast<std::uint32_t>(ends_.size()));
    for (std::vector<std::uint32_t>& some : borders_) {
        std::sort(some.begin(), some.end());
        some.erase(std::unique(some.begin(), some.end()), some.end());
    }
}

std::vector<SilhouetteMesh::Part> SilhouetteMesh::partsOf(std::size_t level,
                                                          std::span<const std::uint32_t> triangles) const {
    std::map<std::uint32_t, std::uint32_t> bits;
    for (const std::uint32_t t : triangles) bits[slots_[level][t] / kLanes] |= 1u << slots_[level][t] % kLanes;
    std::vector<Part> out;
    for (const auto& [cluster, some] : bits) out.push_back({cluster, some});
    return out;
}

void SilhouetteMesh::place(std::span<const glm::vec3> points, const SilhouetteKernel& kernel, unsigned threads,
                           Frame& out) const {
    out.clusters.resize(clusters_.size());
    out.edges.resize(ends_.size());
    constexpr std::size_t kClusters = 8, kEdges = 512;
    const std::size_t ofClusters = (clusters_.size() + kClusters - 1) / kClusters;
    parallelFor(ofClusters + (ends_.size() + kEdges - 1) / kEdges, threads, [&](std::size_t i) {
        if (i < ofClusters) {
            for (std::size_t c = i * kClusters; c < std::min(clusters_.size(), (i + 1) * kClusters); ++c)
                kernel.place(points.data(), &triangles_[kLanes * c], clusters_[c].count, out.clusters[c]);
            return;
        }
        const std::size_t first = (i - ofClusters) * kEdges;
        for (std::size_t e = first; e < std::min(ends_.size(), first + kEdges); ++e) {
            const glm::vec3 p = points[ends_[e].x], q = points[ends_[e].y];
            out.edges[e] = {{p.x, p.y, p.z}, 0, {q.x, q.y, q.z}, 0};
        }
    });
}

void SilhouetteMesh::see(const Frame& frame, const SilhouetteKernel& kernel, std::span<const Receiver> receivers,
                         const GroupBox& box, std::span<const std::span<const std::uint32_t>> corners,
                         std::uint32_t inside, float nearby, Seen& out) const {
    const ReceiverLanes lanes = receiverLanes(receivers, box);
    const std::uint32_t used = (1u << receivers.size()) - 1;
    out.sides.resize(triangles_.size() + 1);
    out.sides.back() = 0;
    out.differing.resize(ends_.size());
    std::size_t meeting = 0;
    for (const std::span<const std::uint32_t>& some : corners) meeting = std::max(meeting, some.size());
    out.dealt.room = ends_.size() + meeting + kLanes;  // each once, and those under which all is
    out.dealt.items.resize(out.dealt.room * kLanes);
    std::fill_n(out.dealt.counts, kLanes, std::size_t{0});
    out.nearPole.room = triangles_.size() + kLanes;
    out.nearPole.items.resize(out.nearPole.room * kLanes);
    std::fill_n(out.nearPole.counts, kLanes, std::size_t{0});
    out.own.resize(triangles_.size());
    const auto markOwn = [&](bool mark) {
        for (std::size_t k = 0; k < receivers.size(); ++k)
            for (const std::uint32_t corner : corners[k]) {
                std::uint32_t& own = out.own[slots_[0][corner / 3]];
                own = mark ? own | 0x10001u << k : 0;
            }
    };
    markOwn(true);
    out.look.assign(clusters_.size(), 0);
    out.seen.resize(clusters_.size(), 1);
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
        std::uint32_t* sides = out.sides.data() + kLanes * c;
        ClusterFlags f = {};
        if (out.members[c]) f = kernel.classify(frame.clusters[c], lanes);
        f.above &= used;
        if (!f.above) {
            if (std::exchange(out.seen[c], 0)) std::fill_n(sides, kLanes, 0u);
            continue;
        }
        const TriangleCluster& placed = frame.clusters[c];
        out.seen[c] = 1;
        out.look[c] |= kBetween;
        for (const std::uint32_t other : borders_[c]) out.look[other] |= kBetween;
        const Cluster& cluster = clusters_[c];
        const std::uint32_t backs = cluster.backs == BackSides::All    ? 0xffffu
                                    : cluster.backs == BackSides::None ? 0
                                                                       : inside;
        const std::uint32_t seen = f.above | (f.above & backs) << 16;
        const glm::vec3 away = glm::vec3(placed.centre[0], placed.centre[1], placed.centre[2]) - box.middle;
        const float nearest = nearby * box.radius + placed.radius + kRounding;
        const ClusterFaces faces = kernel.face(placed, lanes, glm::dot(away, away) > nearest * nearest, seen,
                                               out.members[c], out.own.data() + kLanes * c, sides);
        if (!faces.alike) out.look[c] |= kInside;
        const std::uint32_t some = faces.some;
        kernel.nearPole(placed, static_cast<std::uint32_t>(c), receivers.data(),
                        f.overhead & (some | some >> 16) & used, sides, out.nearPole);
    }
    markOwn(false);
    for (std::size_t k = 0; k < receivers.size(); ++k)
        out.poles[k] = kernel.overhead(frame.clusters.data(), &out.nearPole.items[out.nearPole.room * k],
                                       out.nearPole.counts[k], receivers[k]);
    kernel.differ(edges_, out.sides.data(), out.look.data(), out.differing);
    kernel.deal(frame.edges.data(), lanes, out.differing, out.dealt);
    // The triangles at a receiver span no solid angle, but hide all that lies under them.
    for (std::size_t k = 0; k < receivers.size(); ++k) {
        std::uint32_t* items = out.dealt.items.data() + k * out.dealt.room;
        for (const std::uint32_t corner : corners[k])
            items[out.dealt.counts[k]++] =
                8 * edgesOf_[slots_[0][corner / 3]][static_cast<int>((corner + 1) % 3)] + DealtEdges::kUnder;
    }
}

std::uint32_t SilhouetteMesh::Seen::blocking(std::size_t cluster) const {
    std::uint32_t bits = 0;
    for (std::uint32_t t = 0; t < kLanes; ++t) bits |= (sides[kLanes * cluster + t] != 0 ? 1u : 0u) << t;
    return bits;
}

std::size_t SilhouetteMesh::bytes() const {
    return bytesOf(triangles_) + bytesOf(clusters_) + bytesOf(slots_) + bytesOf(ends_) + bytesOf(edges_.a) +
           bytesOf(edges_.b) + bytesOf(edges_.inside) + bytesOf(edges_.between) + bytesOf(edgesOf_) + bytesOf(borders_);
}

}  // namespace nacre
