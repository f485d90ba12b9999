#include "transfer/frame_blockers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"

namespace nacre {
namespace {

constexpr std::size_t kAtATime = 256, kPatchesAtATime = 8;

/// Distance of a point from a triangle's plane.
float offPlane(const BlockerRow& row, const glm::vec3& p) {
    const float d = row.normal[0] * p.x + row.normal[1] * p.y + row.normal[2] * p.z - row.offset;
    return row.normalLength > 0 ? std::abs(d) / row.normalLength : 0.0f;
}

}  // namespace

MovingLevels::MovingLevels(BlockerLevels levels, std::size_t vertices) : levels_(std::move(levels)) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const auto cut = [](std::vector<Part>& parts, std::size_t level, std::size_t count) {
        for (std::size_t i = 0; i < count; i += kAtATime) parts.push_back({level, i, std::min(i + kAtATime, count)});
    };
    for (std::size_t l = 0; l < levelCount(); ++l) {
        const std::vector<glm::uvec3>& triangles = levels_.levels[l].triangles;
        corners_.push_back(cornersOfVertices(triangles, vertices));
        firstRow_.push_back(static_cast<std::uint32_t>(rowCount_));
        firstPushed_.push_back(static_cast<std::uint32_t>(vertices + pushedCount_));
        used_.emplace_back();
        numbered_.emplace_back();
        if (l == 0) continue;
        rowCount_ += triangles.size();
        cut(rowParts_, l, triangles.size());
        std::vector<std::uint32_t> numberOf(vertices, kNone);
        for (const glm::uvec3& t : triangles)
            for (int c = 0; c < 3; ++c) {
                if (numberOf[t[c]] != kNone) continue;
                numberOf[t[c]] = static_cast<std::uint32_t>(vertices + pushedCount_++);
                used_[l].push_back(t[c]);
            }
        for (const glm::uvec3& t : triangles) numbered_[l].emplace_back(numberOf[t.x], numberOf[t.y], numberOf[t.z]);
        cut(vertexParts_, l, used_[l].size());
    }
    for (const BlockerLevels::Patch& patch : levels_.patches) {
        std::vector<std::uint32_t>& all = patchCorners_.emplace_back();
        float push = 0;
        for (std::size_t l = 0; l < levelCount(); ++l)
            for (const std::uint32_t t : patch.triangles[l])
                for (int c = 0; c < 3; ++c) {
                    all.push_back(levels_.levels[l].triangles[t][c]);
                    push = std::max(push, std::abs(levels_.levels[l].push[all.back()]));
                }
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        patchPush_.push_back(push);
    }
    joined_.resize(patches().size());
    for (std::uint32_t p = 0; p < joined_.size(); ++p) joined_[p].push_back(p);
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (a == b) return;
        joined_[a].push_back(b);
        joined_[b].push_back(a);
    };
    for (std::size_t l = 0; levelCount() > 1 && l + 1 < levelCount(); ++l) {
        const BlockerLevels::Level& level = levels_.levels[l];
        for (const glm::uvec3& t : level.triangles)
            for (int c = 0; c < 3; ++c) join(coarsestOf(t[c]), coarsestOf(t[(c + 1) % 3]));
        for (std::uint32_t v = 0; l > 0 && v < vertices; ++v)
            for (int c = 0; c < 3; ++c) join(coarsestOf(v), coarsestOf(level.triangles[level.triangleOf[v]][c]));
    }
    for (std::uint32_t p = 0; levelCount() > 1 && p < joined_.size(); ++p)
        for (int c = 0; c < 3; ++c) join(p, coarsestOf(levels_.levels.back().triangles[p][c]));
    for (std::vector<std::uint32_t>& some : joined_) {
        std::sort(some.begin(), some.end());
        some.erase(std::unique(some.begin(), some.end()), some.end());
    }
}

void MovingLevels::placePatch(std::span<const glm::vec3> positions, std::size_t p, FrameBlockers& out) const {
    const BlockerLevels::Patch& patch = levels_.patches[p];
    PatchColumns& columns = out.patches;
    const BlockerRow& coarsest = out.rows[firstRow_.back() + patch.triangles.back()[0]];
    for (std::size_t k = 0; k < 9; ++k) columns.corners[k][p] = coarsest.corners[k];
    glm::vec3 low = positions[patchCorners_[p][0]], high = low;
    for (const std::uint32_t v : patchCorners_[p]) {
        low = glm::min(low, positions[v]);
        high = glm::max(high, positions[v]);
    }
    const glm::vec3 centre = 0.5f * (low + high);
    for (int k = 0; k < 3; ++k) columns.centre[k][p] = centre[k];
    columns.radius[p] = 0.5f * glm::length(high - low) + patchPush_[p];
    for (std::size_t l = 1; l < levelCount(); ++l) {
        const BlockerLevels::Level& level = levels_.levels[l];
        float off = level.restError[p];
        for (const std::uint32_t v : patch.vertices)
            off = std::max(off, offPlane(out.rows[firstRow_[l] + level.triangleOf[v]], positions[v]));
        for (const glm::uvec2& pair : patch.nearest[l])
            off = std::max(off, offPlane(out.rows[firstRow_[l] + pair.y], positions[pair.x]));
        columns.off[l][p] = off;
    }
}

std::vector<std::vector<std::uint32_t>> MovingLevels::patchesOfTriangles() const {
    if (levelCount() == 1) return {};
    std::vector<std::vector<std::uint32_t>> out(levelCount());
    for (std::size_t l = 0; l + 1 < levelCount(); ++l)
        for (const glm::uvec3& t : levels_.levels[l].triangles) out[l].push_back(coarsestOf(t.x));
    out.back().resize(coarsestTriangles());
    std::iota(out.back().begin(), out.back().end(), 0u);
    return out;
}

std::vector<glm::vec3> MovingLevels::unpushed(std::span<const glm::vec3> positions) const {
    std::vector<glm::vec3> out(positions.begin(), positions.end());
    for (const std::vector<std::uint32_t>& used : used_)
        for (const std::uint32_t v : used) out.push_back(positions[v]);
    return out;
}

void MovingLevels::place(std::span<const glm::vec3> positions, unsigned threads, FrameBlockers& out) const {
    out.points.resize(positions.size() + pushedCount_);
    std::copy(positions.begin(), positions.end(), out.points.begin());
    if (levelCount() == 1) return;
    out.rows.resize(rowCount_);
    parallelFor(vertexParts_.size(), threads, [&](std::size_t i) {
        const auto& [l, first, end] = vertexParts_[i];
        const BlockerLevels::Level& level = levels_.levels[l];
        for (std::size_t k = first; k < end; ++k) {
            const std::uint32_t v = used_[l][k];
            out.points[firstPushed_[l] + k] = positions[v] + level.push[v] * vertexNormal(corners_[l], v, positions);
        }
    });
    parallelFor(rowParts_.size(), threads, [&](std::size_t i) {
        const auto& [l, first, end] = rowParts_[i];
        for (std::size_t k = first; k < end; ++k) {
            const glm::uvec3& t = triangles(l)[k];
            out.rows[firstRow_[l] + k] = blockerRow(out.points[t.x], out.points[t.y], out.points[t.z]);
        }
    });
    out.patches.resize(patches().size(), levelCount());
    parallelFor((patches().size() + kPatchesAtATime - 1) / kPatchesAtATime, threads, [&](std::size_t i) {
        for (std::size_t p = i * kPatchesAtATime; p < std::min(patches().size(), (i + 1) * kPatchesAtATime); ++p)
            placePatch(positions, p, out);
    });
}

std::size_t FrameBlockers::bytes() const {
    std::size_t sum =
        silhouettes.bytes() + bytesOf(rows) + bytesOf(points) + bytesOf(patches.radius) + bytesOf(patches.off);
    for (const std::vector<float>& column : patches.centre) sum += bytesOf(column);
    for (const std::vector<float>& column : patches.corners) sum += bytesOf(column);
    return sum;
}

std::size_t MovingLevels::bytes() const {
    std::size_t sum = bytesOf(used_) + bytesOf(numbered_) + bytesOf(firstRow_) + bytesOf(firstPushed_) +
                      bytesOf(vertexParts_) + bytesOf(rowParts_) + bytesOf(patchCorners_) + bytesOf(patchPush_) +
                      bytesOf(joined_) + bytesOf(levels_.levels) + bytesOf(levels_.patches);
    for (const CornersOfVertices& corners : corners_) sum += corners.bytes();
    for (const BlockerLevels::Level& level : levels_.levels)
        sum += bytesOf(level.triangles) + bytesOf(level.push) + bytesOf(level.triangleOf) + bytesOf(level.restError);
    for (const BlockerLevels::Patch& patch : levels_.patches)
        sum += bytesOf(patch.vertices) + bytesOf(patch.triangles) + bytesOf(patch.nearest);
    return sum;
}

}  // namespace nacre
