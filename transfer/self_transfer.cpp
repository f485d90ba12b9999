#include "transfer/self_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "transfer/blocker_kernel.hpp"
#include "transfer/thread_seconds.hpp"

namespace nacre {
namespace {

constexpr std::size_t kGroup = kLanes;   ///< vertices that share a list
constexpr std::size_t kTimedGroups = 8;  ///< one of so many is timed

/// All levels in one frame.
struct BlockersNow {
    std::vector<BlockerRow> rows;  ///< level after level
    PatchColumns patches;
};

struct GroupResult {
    std::size_t listed = 0, drawn = 0;
    TransferSeconds seconds;
};

/// What a thread keeps from group to group.
struct Scratch {
    std::vector<std::uint8_t> levels;
    std::vector<std::uint32_t> seen;  ///< [row] the last list that it is in
    std::uint32_t lists = 0;
    std::vector<std::uint32_t> candidates;
    ListedBlockers listed;
    std::vector<std::uint32_t> indices;
    std::vector<std::size_t> counts;
    std::vector<BlockerRow> skirts;
    std::vector<std::uint32_t> skirtIndices;
    std::vector<std::uint32_t> masks;
    std::vector<float> local, world, sums;
    std::vector<Receiver> receivers;
};

void sortUnique(std::vector<std::uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// How far connected parts are from enclosing something: Σ |Σ area vectors| / Σ areas, 0 for closed shells, 1 for flat
/// sheets.
double openness(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions) {
    const std::vector<std::uint32_t> part = connectedParts(triangles, positions.size());
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    double area = 0, open = 0;
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 a = positions[t.x],
                         n = glm::cross(glm::dvec3(positions[t.y]) - a, glm::dvec3(positions[t.z]) - a);
        sums[part[t.x]] += n;
        area += glm::length(n);
    }
    for (const glm::dvec3& n : sums) open += glm::length(n);
    return area > 0 ? open / area : 1;
}

/// A triangle that the tests for facing let pass whichever way it faces.
void passAnySide(BlockerRow& row) {
    row.offset = -1e30f;
    row.normalLength = 1e15f;
}

/// Distance of a point from a triangle's plane.
float offPlane(const BlockerRow& row, const glm::vec3& p) {
    const float d = row.normal[0] * p.x + row.normal[1] * p.y + row.normal[2] * p.z - row.offset;
    return row.normalLength > 0 ? std::abs(d) / row.normalLength : 0.0f;
}

}  // namespace

struct SelfTransfer::State {
    WeldedMesh mesh;
    SelfTransferOptions options;
    BlockerLevels levels;
    std::vector<CornersOfVertices> corners;                ///< [level]
    std::vector<std::vector<std::uint32_t>> patchCorners;  ///< [patch] vertices of all its triangles
    std::vector<std::vector<std::uint32_t>> groups;
    std::vector<std::vector<std::uint32_t>> near;        ///< [group] triangles of the mesh within the rings
    std::vector<std::vector<std::uint8_t>> nearPatches;  ///< [group][patch] that have some of them
    std::vector<std::uint32_t> firstRow;                 ///< [level]
    std::vector<float> angles;                           ///< [group] lodAngle, less where little light gets to
    MaskKernel kernel;
    BlockerKernel blockerKernels;
    std::shared_ptr<const MaskRows> rows;
    std::shared_ptr<const MaskIntegrals> integrals;
    HarmonicRotation rotation;
    std::vector<double> open;

    State(WeldedMesh m, std::span<const glm::vec3> rest, const SelfTransferOptions& o);
    void findNear();
    void fitAngles(std::span<const float> atRest);
    BlockersNow blockers(std::span<const glm::vec3> positions) const;
    std::size_t listBlockers(const BlockersNow& blockersNow, const GroupBounds& bounds, std::size_t group,
                             Scratch& scratch) const;
    void makeSkirts(std::uint32_t vertex, const Receiver& receiver, std::span<const glm::vec3> positions,
                    Scratch& scratch) const;
    GroupResult computeGroup(std::size_t group, std::span<const std::uint32_t> vertices, const BlockersNow& now,
                             std::span<const glm::vec3> positions, const MaskUse& use, TransferFrame& frame) const;
};

SelfTransfer::State::State(WeldedMesh m, std::span<const glm::vec3> rest, const SelfTransferOptions& o)
    : mesh(std::move(m)),
      options(o),
      levels(makeBlockerLevels(mesh, rest, {o.coarse})),
      kernel(maskKernel(o.mask, o.vectors)),
      blockerKernels(blockerKernel(o.vectors)),
      rows(maskRows(o.mask)),
      integrals(maskIntegrals(o.mask, o.order)),
      rotation(o.order),
      open(openTransfer(o.order)) {
    if (options.sides == BlockingSides::Auto)
        options.sides = mesh.closed                            ? BlockingSides::Front
                        : openness(mesh.triangles, rest) < 0.2 ? BlockingSides::Fine
                                                               : BlockingSides::Both;
    for (const BlockerLevels::Level& level : levels.levels) {
        firstRow.push_back(corners.empty() ? 0u
                                           : firstRow.back() + static_cast<std::uint32_t>(
                                                                   levels.levels[corners.size() - 1].triangles.size()));
        corners.push_back(cornersOfVertices(level.triangles, mesh.vertexCount()));
    }
    for (const BlockerLevels::Patch& patch : levels.patches) {
        std::vector<std::uint32_t> vertices;
        for (std::size_t level = 0; level < levels.levels.size(); ++level)
            for (const std::uint32_t t : patch.triangles[level])
                for (int c = 0; c < 3; ++c) vertices.push_back(levels.levels[level].triangles[t][c]);
        sortUnique(vertices);
        patchCorners.push_back(std::move(vertices));
    }
    const std::vector<glm::vec3> normals = vertexNormals(mesh.triangles, corners[0], rest);
    groups = groupReceivers(rest, normals, kGroup);
    angles.assign(groups.size(), static_cast<float>(options.lodAngle));
    findNear();
}

/// Errors count relative to the light that a vertex gets: a group with one that gets little at rest needs finer
/// blockers.
void SelfTransfer::State::fitAngles(std::span<const float> atRest) {
    constexpr double kDark = 0.3;       // of an open vertex's light
    constexpr float kDarkAngle = 0.4f;  // of the other groups' angle
    const std::size_t size = open.size() * open.size();
    for (std::size_t g = 0; g < groups.size(); ++g)
        if (std::any_of(groups[g].begin(), groups[g].end(),
                        [&](std::uint32_t v) { return atRest[size * v] < kDark * open[0]; }))
            angles[g] *= kDarkAngle;
}

/// The triangles of all vertices within the rings.
void SelfTransfer::State::findNear() {
    near.resize(groups.size());
    nearPatches.assign(groups.size(), std::vector<std::uint8_t>(levels.patches.size(), 0));
    if (levels.levels.size() == 1) return;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::vector<std::uint32_t> reached = groups[g];
        for (int ring = 0; ring <= options.rings; ++ring) {
            near[g].clear();
            for (const std::uint32_t v : reached) {
                nearPatches[g][levels.levels.back().triangleOf[v]] = 1;
                for (std::uint32_t i = corners[0].first[v]; i < corners[0].first[v + 1]; ++i)
                    near[g].push_back(corners[0].order[i] / 3);
            }
            sortUnique(near[g]);
            reached.clear();
            for (const std::uint32_t t : near[g])
                for (int c = 0; c < 3; ++c) reached.push_back(mesh.triangles[t][c]);
            sortUnique(reached);
        }
    }
}

BlockersNow SelfTransfer::State::blockers(std::span<const glm::vec3> positions) const {
    BlockersNow out;
    const float extent = extentOf(positions);
    const std::size_t levelCount = levels.levels.size();
    std::vector<std::vector<glm::vec3>> moved(levelCount);
    for (std::size_t l = 0; l < levelCount; ++l) {
        const BlockerLevels::Level& level = levels.levels[l];
        if (l > 0) moved[l] = pushedPositions(level, corners[l], positions, extent);
        const std::span<const glm::vec3> at = l > 0 ? std::span<const glm::vec3>(moved[l]) : positions;
        for (const glm::uvec3& t : level.triangles) out.rows.push_back(blockerRow(at[t.x], at[t.y], at[t.z]));
    }
    if (options.sides == BlockingSides::Fine)
        for (std::size_t t = 0; t < levels.finest(); ++t) passAnySide(out.rows[t]);
    PatchColumns& columns = out.patches;
    columns.resize(levels.patches.size(), levelCount);
    for (std::size_t p = 0; p < levels.patches.size(); ++p) {
        const BlockerLevels::Patch& patch = levels.patches[p];
        const BlockerRow& coarsest = out.rows[firstRow.back() + patch.triangles.back()[0]];
        for (std::size_t k = 0; k < 9; ++k) columns.corners[k][p] = coarsest.corners[k];
        glm::vec3 low(coarsest.corners[0], coarsest.corners[1], coarsest.corners[2]), high = low;
        const auto hold = [&](const glm::vec3& x) {
            low = glm::min(low, x);
            high = glm::max(high, x);
        };
        for (int c = 1; c < 3; ++c)
            hold({coarsest.corners[3 * c], coarsest.corners[3 * c + 1], coarsest.corners[3 * c + 2]});
        for (const std::uint32_t v : patchCorners[p]) {
            hold(positions[v]);
            for (std::size_t l = 1; l + 1 < levelCount; ++l) hold(moved[l][v]);
        }
        const glm::vec3 centre = 0.5f * (low + high);
        for (int k = 0; k < 3; ++k) columns.centre[k][p] = centre[k];
        columns.radius[p] = 0.5f * glm::length(high - low);
        for (std::size_t l = 1; l < levelCount; ++l) {
            float off = levels.levels[l].restError[p] * extent;
            for (const std::uint32_t v : patch.vertices)
                off = std::max(off, offPlane(out.rows[firstRow[l] + levels.levels[l].triangleOf[v]], positions[v]));
            columns.off[l][p] = off;
        }
    }
    return out;
}

/// What may block some vertex of the group. \return blockers before culling
std::size_t SelfTransfer::State::listBlockers(const BlockersNow& blockersNow, const GroupBounds& bounds,
                                              std::size_t group, Scratch& scratch) const {
    const std::size_t rowCount = blockersNow.rows.size(), padded = rowCount + 2 * kLanes;
    if (scratch.seen.size() < rowCount) scratch.seen.resize(rowCount, 0);
    if (scratch.candidates.size() < padded) {
        scratch.candidates.resize(padded);
        scratch.listed.index.resize(padded);
        for (std::vector<float>& c : scratch.listed.columns) c.resize(padded);
    }
    scratch.levels.resize(levels.patches.size() + kLanes);
    blockerKernels.choose(blockersNow.patches, bounds, angles[group], scratch.levels.data());
    ++scratch.lists;
    std::size_t count = 0, hidden = 0;
    const auto add = [&](std::uint32_t row) {
        scratch.candidates[count] = row;
        count += std::exchange(scratch.seen[row], scratch.lists) != scratch.lists;
    };
    for (const std::uint32_t t : near[group]) add(t);
    const bool bothSides = options.sides == BlockingSides::Both;
    for (std::size_t p = 0; p < levels.patches.size(); ++p) {
        std::size_t level = scratch.levels[p] & ~kHiddenPatch;
        // A coarse triangle next to the vertex is harmless while its back lets light through.
        if (bothSides && nearPatches[group][p]) level = 0;
        const std::vector<std::uint32_t>& triangles = levels.patches[p].triangles[level];
        if (scratch.levels[p] & kHiddenPatch)
            hidden += triangles.size();
        else
            for (const std::uint32_t t : triangles) add(firstRow[level] + t);
    }
    blockerKernels.list(blockersNow.rows.data(), scratch.candidates.data(), count, bounds, bothSides, scratch.listed);
    return count + hidden;
}

/// The triangles at the vertex itself span no solid angle, but hide what lies under them: each as a triangle from its
/// far edge down to −n.
void SelfTransfer::State::makeSkirts(std::uint32_t vertex, const Receiver& receiver,
                                     std::span<const glm::vec3> positions, Scratch& scratch) const {
    scratch.skirts.clear();
    const glm::vec3 &p = positions[vertex], &n = receiver.normal;
    const auto rises = [&](const glm::vec3& d) {
        const float height = glm::dot(d, n);
        return height > 0 && height * height > 1e-12f * glm::dot(d, d);
    };
    for (std::uint32_t i = corners[0].first[vertex]; i < corners[0].first[vertex + 1]; ++i) {
        const glm::uvec3& t = mesh.triangles[corners[0].order[i] / 3];
        const int c = static_cast<int>(corners[0].order[i] % 3);
        const glm::vec3 a = positions[t[(c + 1) % 3]] - p, b = positions[t[(c + 2) % 3]] - p;
        if (!rises(a) && !rises(b)) continue;
        const glm::vec3 under = -glm::length(a) * n;
        const bool turned = glm::dot(a, glm::cross(b, under)) > 0;  // to face the vertex
        scratch.skirts.push_back(turned ? blockerRow(p + b, p + a, p + under) : blockerRow(p + a, p + b, p + under));
    }
    scratch.skirtIndices.resize(scratch.skirts.size() + kLanes);
    std::iota(scratch.skirtIndices.begin(), scratch.skirtIndices.end(), 0u);
}

GroupResult SelfTransfer::State::computeGroup(std::size_t group, std::span<const std::uint32_t> vertices,
                                              const BlockersNow& blockersNow, std::span<const glm::vec3> positions,
                                              const MaskUse& use, TransferFrame& frame) const {
    static thread_local Scratch scratch;
    GroupResult result;
    // Asking for the time costs as much as a vertex: every eighth group stands for the others.
    const bool timed = group % kTimedGroups == 0;
    const auto now = [&] { return timed ? threadSeconds() : 0.0; };
    const double start = now();
    const GroupBounds bounds = boundsOfGroup(vertices, positions, frame.normals);
    result.listed = listBlockers(blockersNow, bounds, group, scratch) * vertices.size();
    const std::size_t room = scratch.listed.count + 2 * kLanes;
    scratch.indices.resize(room * vertices.size());
    scratch.counts.resize(vertices.size());
    scratch.receivers.resize(vertices.size());
    const bool bothSides = options.sides == BlockingSides::Both, drawBoth = options.sides != BlockingSides::Front;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        scratch.receivers[i] = receiverAt(positions[vertices[i]], frame.normals[vertices[i]]);
        scratch.counts[i] =
            blockerKernels.cull(scratch.listed, scratch.receivers[i], bothSides, &scratch.indices[room * i]);
        result.drawn += scratch.counts[i];
    }
    const double listed = now();
    const std::size_t words = maskWords(options.mask);
    scratch.masks.assign(words * vertices.size(), 0);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        kernel.draw(*rows, blockersNow.rows.data(), scratch.receivers[i], drawBoth, &scratch.indices[room * i],
                    scratch.counts[i], &scratch.masks[words * i]);
        makeSkirts(vertices[i], scratch.receivers[i], positions, scratch);
        kernel.draw(*rows, scratch.skirts.data(), scratch.receivers[i], drawBoth, scratch.skirtIndices.data(),
                    scratch.skirts.size(), &scratch.masks[words * i]);
        result.drawn += scratch.skirts.size();
    }
    if (use)
        for (std::size_t i = 0; i < vertices.size(); ++i)
            use(vertices[i], scratch.receivers[i], std::span(scratch.masks).subspan(words * i, words));
    const double drawn = now();
    const std::size_t size = static_cast<std::size_t>((options.order + 1) * (options.order + 1));
    scratch.local.assign(size * kLanes, 0);
    scratch.world.resize(size * vertices.size());
    scratch.sums.resize(static_cast<std::size_t>(2 * kLanes * integrals->groups));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        kernel.integrate(*integrals, &scratch.masks[words * i], scratch.sums.data());
        for (int l = 0, pair = 0; l <= options.order; ++l)
            for (int m = 0; m <= l; ++m, ++pair) {
                const float* sums = &scratch.sums[static_cast<std::size_t>(pair / kLanes * 2 * kLanes + pair % kLanes)];
                const auto local = [&](int c) -> float& {
                    return scratch.local[static_cast<std::size_t>(c) * kLanes + i];
                };
                local(l * l + l + m) =
                    (m == 0 ? static_cast<float>(open[static_cast<std::size_t>(l)]) : 0.0f) - sums[0];
                if (m > 0) local(l * l + l - m) = -sums[kLanes];
            }
    }
    rotation.turn(scratch.receivers.data(), vertices.size(), scratch.local.data(), scratch.world.data());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        std::copy_n(&scratch.world[size * i], size, &frame.coefficients[size * vertices[i]]);
    const double end = now();
    result.seconds = {drawn - listed, end - drawn, listed - start, 0};
    return result;
}

SelfTransfer::SelfTransfer(WeldedMesh mesh, std::span<const glm::vec3> rest, const SelfTransferOptions& options) {
    require(options.rings == 1 || options.rings == 2, "transfer: expected 1 or 2 rings");
    require(std::isfinite(options.lodAngle) && options.lodAngle >= 0, "transfer: expected an angle of 0 or more");
    require(rest.size() == mesh.vertexCount(), "transfer: expected a position a vertex");
    state_ = std::make_unique<State>(std::move(mesh), rest, options);
    if (options.coarse > 0 && !rest.empty()) state_->fitAngles(compute(rest).coefficients);
}
SelfTransfer::~SelfTransfer() = default;
SelfTransfer::SelfTransfer(SelfTransfer&&) noexcept = default;

const WeldedMesh& SelfTransfer::mesh() const { return state_->mesh; }
const SelfTransferOptions& SelfTransfer::options() const { return state_->options; }
std::size_t SelfTransfer::coarseTriangles() const { return state_->levels.levels.back().triangles.size(); }

TransferFrame SelfTransfer::compute(std::span<const glm::vec3> given, std::span<const std::uint8_t> wanted,
                                    const MaskUse& use) const {
    const State& s = *state_;
    require(given.size() == s.mesh.vertexCount(), "transfer: expected a position a vertex");
    require(wanted.empty() || wanted.size() == given.size(), "transfer: expected one mark a vertex");
    for (const glm::vec3& p : given)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
                "transfer: positions that are not finite");
    const double start = threadSeconds();
    // About the first vertex: far from the origin floats are coarse.
    std::vector<glm::vec3> positions(given.begin(), given.end());
    for (glm::vec3& p : positions) p -= given[0];
    TransferFrame frame;
    frame.coefficients.assign(
        positions.size() * static_cast<std::size_t>((s.options.order + 1) * (s.options.order + 1)), 0);
    frame.normals = vertexNormals(s.mesh.triangles, s.corners[0], positions, s.options.threads);
    const BlockersNow blockersNow = s.blockers(positions);
    const double prepared = threadSeconds();
    std::vector<std::vector<std::uint32_t>> chosen(s.groups.size());
    std::vector<GroupResult> results(s.groups.size());
    for (std::size_t g = 0; g < s.groups.size(); ++g)
        for (const std::uint32_t v : s.groups[g])
            if ((wanted.empty() || wanted[v]) && frame.normals[v] != glm::vec3(0)) chosen[g].push_back(v);
    parallelFor(s.groups.size(), s.options.threads, [&](std::size_t g) {
        if (!chosen[g].empty()) results[g] = s.computeGroup(g, chosen[g], blockersNow, positions, use, frame);
    });
    frame.seconds.transform = prepared - start;
    TransferSeconds timed;
    std::size_t timedVertices = 0;
    for (std::size_t g = 0; g < s.groups.size(); ++g) {
        frame.computed += chosen[g].size();
        frame.listed += static_cast<double>(results[g].listed);
        frame.drawn += static_cast<double>(results[g].drawn);
        timed.rasterization += results[g].seconds.rasterization;
        timed.integration += results[g].seconds.integration;
        timed.transform += results[g].seconds.transform;
        if (g % kTimedGroups == 0) timedVertices += chosen[g].size();
    }
    if (timedVertices > 0) {
        const double all = static_cast<double>(frame.computed) / static_cast<double>(timedVertices);
        frame.seconds.rasterization += all * timed.rasterization;
        frame.seconds.integration += all * timed.integration;
        frame.seconds.transform += all * timed.transform;
    }
    if (frame.computed > 0) {
        frame.listed /= static_cast<double>(frame.computed);
        frame.drawn /= static_cast<double>(frame.computed);
    }
    return frame;
}

}  // namespace nacre
