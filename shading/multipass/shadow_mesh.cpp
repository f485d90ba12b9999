#include "shading/multipass/shadow_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>

#include "core/error.hpp"

namespace nacre {
namespace {

/// The number of each vertex's position among the distinct ones, which go to `distinct`.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions, std::vector<glm::vec3>& distinct) {
    const auto key = [&](std::uint32_t i) { return std::tie(positions[i].x, positions[i].y, positions[i].z); };
    std::vector<std::uint32_t> order(positions.size()), out(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || key(order[i]) != key(order[i - 1])) distinct.push_back(positions[order[i]]);
        out[order[i]] = static_cast<std::uint32_t>(distinct.size() - 1);
    }
    return out;
}

/// Drops triangles with a corner twice and those whose corners another one has, in either order: what a second one
/// blocks is blocked already.
void addTriangles(ShadowMesh& out, const Mesh& mesh, const std::vector<std::uint32_t>& weldOf) {
    std::vector<std::pair<std::array<std::uint32_t, 3>, glm::uvec3>> kept;
    std::vector<std::uint32_t> order;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::uvec3 w(weldOf[t.x], weldOf[t.y], weldOf[t.z]);
        if (w.x == w.y || w.y == w.z || w.z == w.x) continue;
        std::array<std::uint32_t, 3> corners{w.x, w.y, w.z};
        std::sort(corners.begin(), corners.end());
        order.push_back(static_cast<std::uint32_t>(kept.size()));
        kept.emplace_back(corners, w);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return kept[a].first < kept[b].first; });
    const auto last = std::unique(order.begin(), order.end(),
                                  [&](std::uint32_t a, std::uint32_t b) { return kept[a].first == kept[b].first; });
    order.erase(last, order.end());
    std::sort(order.begin(), order.end());
    for (const std::uint32_t i : order) out.triangles.push_back(kept[i].second);
}

void addEdges(ShadowMesh& out) {
    struct Use {
        std::uint32_t low, high, use;
    };
    std::vector<Use> all;
    for (std::uint32_t t = 0; t < out.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t a = out.triangles[t][c], b = out.triangles[t][(c + 1) % 3];
            all.push_back({std::min(a, b), std::max(a, b), 2 * t + (a > b ? 1u : 0u)});
        }
    std::sort(all.begin(), all.end(), [](const Use& a, const Use& b) {
        return std::tie(a.low, a.high, a.use) < std::tie(b.low, b.high, b.use);
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i == 0 || all[i].low != all[i - 1].low || all[i].high != all[i - 1].high) {
            out.edges.emplace_back(all[i].low, all[i].high);
            out.firstUse.push_back(static_cast<std::uint32_t>(i));
        }
        out.uses.push_back(all[i].use);
    }
    out.firstUse.push_back(static_cast<std::uint32_t>(all.size()));
}

bool isSolid(const ShadowMesh& mesh) {
    std::vector<std::uint32_t> parent(mesh.triangles.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t t) {
        while (parent[t] != t) t = parent[t] = parent[parent[t]];
        return t;
    };
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        const auto uses = mesh.usesOf(e);
        if (uses.size() != 2 || (uses[0] & 1) == (uses[1] & 1)) return false;
        parent[root(uses[0] / 2)] = root(uses[1] / 2);
    }
    std::vector<double> volume(mesh.triangles.size(), 0);  // of the part, at its root
    const Vec3 origin = mesh.positions.empty() ? Vec3(0) : Vec3(mesh.positions.front());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& c = mesh.triangles[t];
        const auto corner = [&](std::uint32_t i) { return Vec3(mesh.positions[i]) - origin; };
        volume[root(t)] += glm::dot(corner(c.x), glm::cross(corner(c.y), corner(c.z)));
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (root(t) == t && !(volume[t] > 0)) return false;
    return !mesh.triangles.empty();
}

/// Triangles in front of one plane.
class PlaneCut {
public:
    PlaneCut(std::vector<glm::vec3>& positions, const glm::dvec4& plane) : positions_(positions), plane_(plane) {}

    void operator()(const glm::uvec3& triangle, std::vector<glm::uvec3>& out) {
        std::vector<std::uint32_t> left;
        bool inFront = false;
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t a = triangle[c], b = triangle[(c + 1) % 3];
            const double ha = height(a), hb = height(b);
            if (ha >= 0) left.push_back(a);
            if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) left.push_back(between(std::min(a, b), std::max(a, b)));
            inFront = inFront || ha > 0;
        }
        if (!inFront) return;
        for (std::size_t i = 1; i + 1 < left.size(); ++i) out.emplace_back(left[0], left[i], left[i + 1]);
    }

private:
    double height(std::uint32_t i) const { return glm::dot(plane_, glm::dvec4(positions_[i], 1)); }
    std::uint32_t between(std::uint32_t a, std::uint32_t b) {
        const auto [at, fresh] = cuts_.try_emplace({a, b}, static_cast<std::uint32_t>(positions_.size()));
        if (fresh) {
            const double ha = height(a), hb = height(b);
            positions_.emplace_back(glm::mix(Vec3(positions_[a]), Vec3(positions_[b]), ha / (ha - hb)));
        }
        return at->second;
    }

    std::vector<glm::vec3>& positions_;
    glm::dvec4 plane_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cuts_;
};

}  // namespace

CutShadowMesh cutShadowMesh(const ShadowMesh& mesh, std::span<const glm::dvec4> planes) {
    CutShadowMesh out;
    out.pieces.positions = mesh.positions;
    out.pieces.triangles = mesh.triangles;
    out.from.resize(mesh.triangles.size());
    std::iota(out.from.begin(), out.from.end(), 0u);
    for (const glm::dvec4& plane : planes) {
        PlaneCut cut(out.pieces.positions, plane);
        std::vector<glm::uvec3> left;
        std::vector<std::uint32_t> from;
        for (std::size_t t = 0; t < out.pieces.triangles.size(); ++t) {
            cut(out.pieces.triangles[t], left);
            from.resize(left.size(), out.from[t]);
        }
        out.pieces.triangles = std::move(left);
        out.from = std::move(from);
    }
    addEdges(out.pieces);
    return out;
}

ShadowMesh makeShadowMesh(const Mesh& mesh) {
    for (const glm::vec3& p : mesh.positions) require(isFinite(Vec3(p)), "shadow volume: a position is not finite");
    for (const glm::uvec3& t : mesh.triangles)
        require(std::max(t.x, std::max(t.y, t.z)) < mesh.positions.size(), "shadow volume: vertex index out of range");
    ShadowMesh out;
    addTriangles(out, mesh, weld(mesh.positions, out.positions));
    addEdges(out);
    out.solid = isSolid(out);
    return out;
}

}  // namespace nacre
