#include "transfer/blocker_lists.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace nacre {
namespace {

constexpr std::uint32_t kNoCluster = std::numeric_limits<std::uint32_t>::max();

void sortUnique(std::vector<std::uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

BlockerLists::BlockerLists(const MovingLevels& levels, const SilhouetteMesh& silhouettes)
    : levels_(levels), silhouettes_(silhouettes) {
    const std::size_t count = levels.levelCount(), patches = levels.patches().size();
    if (count == 1) return;
    for (const BlockerLevels::Patch& patch : levels.patches())
        for (std::size_t l = 0; l < count; ++l) {
            firstPart_.push_back(static_cast<std::uint32_t>(parts_.size()));
            const std::vector<SilhouetteMesh::Part> some = silhouettes.partsOf(l, patch.triangles[l]);
            parts_.insert(parts_.end(), some.begin(), some.end());
        }
    firstPart_.push_back(static_cast<std::uint32_t>(parts_.size()));
    coarsestMembers_.resize(silhouettes.clusterCount());
    for (std::size_t p = 0; p < patches; ++p)
        for (const SilhouetteMesh::Part& part : partsOf(p, count - 1)) coarsestMembers_[part.cluster] |= part.triangles;
    for (std::size_t p = 0; p < patches; p += kLanes) {
        const std::uint32_t cluster = parts_[firstPart_[count * p + count - 1]].cluster;
        bool alike = true;
        for (std::size_t k = 0; k < std::min<std::size_t>(kLanes, patches - p); ++k) {
            const SilhouetteMesh::Part& part = parts_[firstPart_[count * (p + k) + count - 1]];
            alike &= part.cluster == cluster && part.triangles == 1u << k;
        }
        coarsest_.push_back(alike ? cluster : kNoCluster);
    }
}

/// The triangles of all vertices within the rings, and the patches that a triangle of some level joins with theirs: no
/// coarse one lies over the group.
void BlockerLists::setGroups(std::span<const std::vector<std::uint32_t>> groups, const WeldedMesh& mesh,
                             const CornersOfVertices& corners, const BlockingParts& parts, int rings) {
    near_.assign(groups.size(), {});
    nearPatches_.assign(groups.size(), {});
    if (levels_.levelCount() == 1) return;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::vector<std::uint32_t> reached = groups[g], triangles;
        for (int ring = 0; ring <= rings; ++ring) {
            triangles.clear();
            for (const std::uint32_t v : reached) {
                if (parts.sheets[v])
                    for (const std::uint32_t patch : levels_.joined(levels_.coarsestOf(v)))
                        nearPatches_[g].push_back(patch);
                for (std::uint32_t i = corners.first[v]; i < corners.first[v + 1]; ++i)
                    triangles.push_back(corners.order[i] / 3);
            }
            sortUnique(triangles);
            reached.clear();
            for (const std::uint32_t t : triangles)
                for (int c = 0; c < 3; ++c) reached.push_back(mesh.triangles[t][c]);
            sortUnique(reached);
        }
        sortUnique(nearPatches_[g]);
        near_[g] = silhouettes_.partsOf(0, triangles);
    }
}

std::span<const SilhouetteMesh::Part> BlockerLists::partsOf(std::size_t patch, std::size_t level) const {
    const std::uint32_t* part = &firstPart_[levels_.levelCount() * patch + level];
    return std::span(parts_).subspan(part[0], part[1] - part[0]);
}

std::size_t BlockerLists::list(std::size_t group, const GroupBounds& bounds, std::optional<float> angle,
                               const FrameBlockers& blockers, const BlockerKernel& kernel, Room& room,
                               std::vector<std::uint32_t>& members) const {
    const std::size_t patches = levels_.patches().size(), count = levels_.levelCount();
    if (count == 1) {
        members.resize(silhouettes_.clusterCount());
        for (std::size_t c = 0; c < members.size(); ++c) members[c] = silhouettes_.all(c);
        return 0;
    }
    const auto add = [&](const SilhouetteMesh::Part& part) { members[part.cluster] |= part.triangles; };
    if (!angle) {
        members = coarsestMembers_;
        for (const std::uint32_t p : nearPatches_[group]) {
            for (const SilhouetteMesh::Part& part : partsOf(p, count - 1)) members[part.cluster] &= ~part.triangles;
            std::ranges::for_each(partsOf(p, 0), add);
        }
        std::ranges::for_each(near_[group], add);
        return 0;
    }
    members.assign(silhouettes_.clusterCount(), 0);
    room.levels.resize(patches + kLanes);
    room.hidden.resize(patches / kLanes + 1);
    kernel.choose(blockers.patches, bounds, *angle, room.levels.data(), room.hidden.data());
    // A coarse triangle next to the vertex is harmless while its back lets light through.
    for (const std::uint32_t p : nearPatches_[group]) room.levels[p] = 0;
    std::ranges::for_each(near_[group], add);
    std::size_t hidden = 0;
    for (std::size_t first = 0; first < patches; first += kLanes) {
        const std::size_t block = first / kLanes;
        const std::uint8_t* level = &room.levels[first];
        const std::uint32_t all = (1u << std::min<std::size_t>(kLanes, patches - first)) - 1;
        std::uint32_t left = all & ~std::uint32_t{room.hidden[block]};
        hidden += static_cast<std::size_t>(std::popcount(all & ~left));
        if (coarsest_[block] != kNoCluster) {
            std::uint32_t coarsest = 0;
            for (std::size_t k = 0; k < kLanes; ++k) coarsest |= (level[k] + 1u == count ? 1u : 0u) << k;
            members[coarsest_[block]] |= coarsest & left;
            left &= ~coarsest;
        }
        for (; left; left &= left - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(left));
            std::ranges::for_each(partsOf(first + k, level[k]), add);
        }
    }
    return hidden;
}

std::size_t BlockerLists::bytes() const {
    return bytesOf(parts_) + bytesOf(firstPart_) + bytesOf(coarsestMembers_) + bytesOf(coarsest_) + bytesOf(near_) +
           bytesOf(nearPatches_);
}

}  // namespace nacre
