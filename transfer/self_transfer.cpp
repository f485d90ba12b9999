#include "transfer/self_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "transfer/receiver_groups.hpp"

namespace nacre {
namespace {

constexpr std::size_t kGroup = 16;  ///< vertices that share a list

/// Of this thread: what waits for a processor isn't work.
double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Triangle {
    glm::vec3 corners[3], normal;
    float offset, normalLength;
};

/// A patch in one frame.
struct PatchNow {
    glm::vec3 centre{0}, corners[3];  ///< corners of the coarsest level's triangle
    float radius = 0;
    std::vector<float> off;  ///< [level] how far the level is from the mesh [world units]
};

/// All levels in one frame.
struct BlockersNow {
    std::vector<std::vector<Triangle>> levels;
    std::vector<PatchNow> patches;
};

struct GroupResult {
    std::size_t listed = 0, drawn = 0;
    TransferSeconds seconds;
};

/// What a thread keeps from group to group.
struct Scratch {
    BlockerList list;
    std::vector<std::vector<std::uint32_t>> seen;  ///< [level][triangle] the last list that it is in
    std::uint32_t lists = 0;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> masks;
    std::vector<float> local, world, sums;
    std::vector<int> counts;
    std::vector<Receiver> receivers;
};

glm::vec3 anyTangent(const glm::vec3& n) {  // Duff et al. 2017
    const float s = std::copysign(1.0f, n.z), a = -1 / (s + n.z);
    return {1 + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x};
}

Receiver receiverAt(const glm::vec3& point, const glm::vec3& normal) {
    const glm::vec3 tangent = anyTangent(normal);
    return {point, tangent, glm::cross(normal, tangent), normal};
}

Triangle triangleOf(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 n = glm::cross(b - a, c - a);
    return {{a, b, c}, n, glm::dot(n, a), glm::length(n)};
}

void sortUnique(std::vector<std::uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

float offPlane(const Triangle& t, const glm::vec3& p) {
    return t.normalLength > 0 ? std::abs(glm::dot(t.normal, p) - t.offset) / t.normalLength : 0.0f;
}

}  // namespace

struct SelfTransfer::State {
    WeldedMesh mesh;
    SelfTransferOptions options;
    BlockerLevels levels;
    std::vector<CornersOfVertices> corners;                ///< [level]
    std::vector<std::vector<std::uint32_t>> patchCorners;  ///< [patch] vertices of all its triangles
    std::vector<std::vector<std::uint32_t>> groups;
    std::vector<std::vector<std::uint32_t>> near;  ///< [group] triangles of the mesh within the rings
    std::vector<std::vector<std::uint8_t>> nearPatches;  ///< [group][patch] that have some of them
    MaskKernel kernel;
    std::shared_ptr<const MaskRows> rows;
    std::shared_ptr<const MaskIntegrals> integrals;
    HarmonicRotation rotation;
    std::vector<double> open;

    State(WeldedMesh m, std::span<const glm::vec3> rest, const SelfTransferOptions& o);
    void findNear();
    BlockersNow blockers(std::span<const glm::vec3> positions) const;
    std::size_t levelFor(const PatchNow& patch, const GroupBounds& group) const;
    std::size_t listBlockers(const BlockersNow& now, const GroupBounds& bounds, std::size_t group, Scratch& scratch) const;
    void addSkirts(std::uint32_t vertex, const Receiver& receiver, const glm::vec3& centre, std::span<const glm::vec3> positions,
                   Scratch& scratch, std::uint32_t* indices, int& count) const;
    GroupResult computeGroup(std::size_t group, std::span<const std::uint32_t> vertices, const BlockersNow& now,
                             std::span<const glm::vec3> positions, TransferFrame& frame) const;
};

SelfTransfer::State::State(WeldedMesh m, std::span<const glm::vec3> rest, const SelfTransferOptions& o)
    : mesh(std::move(m)), options(o), levels(makeBlockerLevels(mesh, rest, {o.coarse})),
      kernel(maskKernel(o.mask, o.vectors)), rows(maskRows(o.mask)), integrals(maskIntegrals(o.mask, o.order)), rotation(o.order),
      open(openTransfer(o.order)) {
    if (options.sides == BlockingSides::Auto) options.sides = mesh.closed ? BlockingSides::Front : BlockingSides::Both;
    for (const BlockerLevels::Level& level : levels.levels)
        corners.push_back(cornersOfVertices(level.triangles, mesh.vertexCount()));
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
    findNear();
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
    std::vector<std::vector<glm::vec3>> moved(levels.levels.size());
    for (std::size_t l = 0; l < levels.levels.size(); ++l) {
        const BlockerLevels::Level& level = levels.levels[l];
        if (l > 0) moved[l] = pushedPositions(level, corners[l], positions, extent);
        const std::span<const glm::vec3> at = l > 0 ? std::span<const glm::vec3>(moved[l]) : positions;
        out.levels.emplace_back(level.triangles.size());
        for (std::size_t t = 0; t < level.triangles.size(); ++t)
            out.levels[l][t] = triangleOf(at[level.triangles[t].x], at[level.triangles[t].y], at[level.triangles[t].z]);
    }
    out.patches.resize(levels.patches.size());
    for (std::size_t p = 0; p < levels.patches.size(); ++p) {
        const BlockerLevels::Patch& patch = levels.patches[p];
        PatchNow& patchNow = out.patches[p];
        const Triangle& coarsest = out.levels.back()[patch.triangles.back()[0]];
        glm::vec3 low = coarsest.corners[0], high = low;
        const auto hold = [&](const glm::vec3& x) {
            low = glm::min(low, x);
            high = glm::max(high, x);
        };
        hold(coarsest.corners[1]);
        hold(coarsest.corners[2]);
        for (const std::uint32_t v : patchCorners[p]) {
            hold(positions[v]);
            if (levels.levels.size() == 3) hold(moved[1][v]);
        }
        patchNow.centre = 0.5f * (low + high);
        patchNow.radius = 0.5f * glm::length(high - low);
        for (int c = 0; c < 3; ++c) patchNow.corners[c] = coarsest.corners[c];
        patchNow.off.assign(levels.levels.size(), 0);
        for (std::size_t l = 1; l < levels.levels.size(); ++l)
            for (const std::uint32_t v : patch.vertices)
                patchNow.off[l] = std::max(patchNow.off[l], offPlane(out.levels[l][levels.levels[l].triangleOf[v]], positions[v]));
    }
    return out;
}

/// The coarsest level that is off by less than the angle, seen from the group's vertex nearest to the patch.
std::size_t SelfTransfer::State::levelFor(const PatchNow& patch, const GroupBounds& group) const {
    float nearest = glm::distance(patch.centre, group.centre);
    for (const glm::vec3& c : patch.corners) nearest = std::min(nearest, glm::distance(c, group.centre));
    // What touches the group is fine until the angle is large: there an error is seen from no distance at all.
    const float angle = static_cast<float>(options.lodAngle);
    const float allowed = angle * std::max(nearest - group.radius, 0.2f * angle * glm::distance(patch.centre, group.centre));
    for (std::size_t l = levels.levels.size() - 1; l > 0; --l)
        if (patch.off[l] <= allowed) return l;
    return 0;
}

/// What may block some vertex of the group, about its centre. \return blockers before culling
std::size_t SelfTransfer::State::listBlockers(const BlockersNow& blockersNow, const GroupBounds& bounds, std::size_t group,
                                              Scratch& scratch) const {
    std::size_t listed = 0;
    if (scratch.seen.size() != levels.levels.size()) scratch.seen.resize(levels.levels.size());
    for (std::size_t l = 0; l < levels.levels.size(); ++l) scratch.seen[l].resize(levels.levels[l].triangles.size(), 0);
    ++scratch.lists;
    std::size_t room = 0;
    for (const BlockerLevels::Level& level : levels.levels) room += level.triangles.size();
    scratch.list.start(room);
    const bool frontOnly = options.sides == BlockingSides::Front;
    const auto list = [&](std::size_t l, std::uint32_t t) {
        if (std::exchange(scratch.seen[l][t], scratch.lists) == scratch.lists) return;
        ++listed;
        const Triangle& b = blockersNow.levels[l][t];
        const float facing = glm::dot(b.normal, bounds.centre) - b.offset;
        if (frontOnly && facing + b.normalLength * bounds.radius < 0) return;
        scratch.list.add(b.corners[0] - bounds.centre, b.corners[1] - bounds.centre, b.corners[2] - bounds.centre, b.normal, -facing);
    };
    for (const std::uint32_t t : near[group]) list(0, t);
    for (std::size_t p = 0; p < levels.patches.size(); ++p) {
        const PatchNow& patch = blockersNow.patches[p];
        // A coarse triangle next to the vertex is harmless while its back lets light through.
        const std::size_t l = !frontOnly && nearPatches[group][p] ? 0 : levelFor(patch, bounds);
        const bool hidden = belowHorizon(bounds, patch.centre, patch.radius);
        if (hidden)
            listed += levels.patches[p].triangles[l].size();
        else
            for (const std::uint32_t t : levels.patches[p].triangles[l]) list(l, t);
    }
    scratch.list.pad();
    return listed;
}

/// The triangles at the vertex itself span no solid angle, but hide what lies under them: each as a triangle from its
/// far edge down to −n.
void SelfTransfer::State::addSkirts(std::uint32_t vertex, const Receiver& receiver, const glm::vec3& centre,
                                    std::span<const glm::vec3> positions, Scratch& scratch, std::uint32_t* indices, int& count) const {
    for (std::uint32_t i = corners[0].first[vertex]; i < corners[0].first[vertex + 1]; ++i) {
        const glm::uvec3& t = mesh.triangles[corners[0].order[i] / 3];
        const int c = static_cast<int>(corners[0].order[i] % 3);
        const glm::vec3 a = positions[t[(c + 1) % 3]] - positions[vertex], b = positions[t[(c + 2) % 3]] - positions[vertex];
        const float reach = glm::length(a);
        if (glm::dot(a, receiver.normal) <= 1e-6f * reach && glm::dot(b, receiver.normal) <= 1e-6f * glm::length(b)) continue;
        const glm::vec3 under = -receiver.normal * reach;
        const bool turned = glm::dot(a, glm::cross(b, under)) > 0;  // to face the vertex
        const glm::vec3 p = positions[vertex] - centre;
        indices[count++] = scratch.list.addDrawnOnly(p + (turned ? b : a), p + (turned ? a : b), p + under);
    }
}

GroupResult SelfTransfer::State::computeGroup(std::size_t group, std::span<const std::uint32_t> vertices, const BlockersNow& blockersNow,
                                              std::span<const glm::vec3> positions, TransferFrame& frame) const {
    static thread_local Scratch scratch;
    GroupResult result;
    const double start = now();
    const GroupBounds bounds = boundsOfGroup(vertices, positions, frame.normals);
    result.listed = listBlockers(blockersNow, bounds, group, scratch) * vertices.size();
    std::size_t skirts = 0;
    for (const std::uint32_t v : vertices) skirts = std::max<std::size_t>(skirts, corners[0].first[v + 1] - corners[0].first[v]);
    const std::size_t room = scratch.list.count + skirts + 2 * kLanes;
    scratch.indices.resize(room * vertices.size());
    scratch.counts.resize(vertices.size());
    scratch.receivers.resize(vertices.size());
    const bool bothSides = options.sides == BlockingSides::Both;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::uint32_t v = vertices[i];
        Receiver& receiver = scratch.receivers[i] = receiverAt(positions[v] - bounds.centre, frame.normals[v]);
        std::uint32_t* indices = &scratch.indices[room * i];
        int count = kernel.cull(scratch.list, receiver, 0, bothSides, indices);
        addSkirts(v, receiver, bounds.centre, positions, scratch, indices, count);
        scratch.counts[i] = count;
        result.drawn += static_cast<std::size_t>(count);
    }
    const double listed = now();
    const std::size_t words = maskWords(options.mask);
    scratch.masks.assign(words * vertices.size(), 0);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        kernel.draw(*rows, scratch.list.byTriangle.data(), scratch.receivers[i], bothSides, &scratch.indices[room * i],
                    scratch.counts[i], &scratch.masks[words * i]);
    const double drawn = now();
    const std::size_t size = static_cast<std::size_t>((options.order + 1) * (options.order + 1));
    scratch.local.resize(size * vertices.size());
    scratch.world.resize(size * vertices.size());
    scratch.sums.resize(static_cast<std::size_t>(2 * kLanes * integrals->groups));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        kernel.integrate(*integrals, &scratch.masks[words * i], scratch.sums.data());
        float* local = &scratch.local[size * i];
        for (int l = 0, pair = 0; l <= options.order; ++l)
            for (int m = 0; m <= l; ++m, ++pair) {
                const float* sums = &scratch.sums[static_cast<std::size_t>(pair / kLanes * 2 * kLanes + pair % kLanes)];
                local[l * l + l + m] = (m == 0 ? static_cast<float>(open[static_cast<std::size_t>(l)]) : 0.0f) - sums[0];
                if (m > 0) local[l * l + l - m] = -sums[kLanes];
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
}
SelfTransfer::~SelfTransfer() = default;
SelfTransfer::SelfTransfer(SelfTransfer&&) noexcept = default;

const WeldedMesh& SelfTransfer::mesh() const { return state_->mesh; }
const SelfTransferOptions& SelfTransfer::options() const { return state_->options; }
std::size_t SelfTransfer::coarseTriangles() const { return state_->levels.levels.back().triangles.size(); }

TransferFrame SelfTransfer::compute(std::span<const glm::vec3> positions, std::span<const std::uint8_t> wanted) const {
    const State& s = *state_;
    require(positions.size() == s.mesh.vertexCount(), "transfer: expected a position a vertex");
    require(wanted.empty() || wanted.size() == positions.size(), "transfer: expected one mark a vertex");
    for (const glm::vec3& p : positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "transfer: positions that are not finite");
    const double start = now();
    TransferFrame frame;
    frame.coefficients.assign(positions.size() * static_cast<std::size_t>((s.options.order + 1) * (s.options.order + 1)), 0);
    frame.normals = vertexNormals(s.mesh.triangles, s.corners[0], positions, s.options.threads);
    const BlockersNow blockersNow = s.blockers(positions);
    const double prepared = now();
    std::vector<std::vector<std::uint32_t>> chosen(s.groups.size());
    std::vector<GroupResult> results(s.groups.size());
    for (std::size_t g = 0; g < s.groups.size(); ++g)
        for (const std::uint32_t v : s.groups[g])
            if ((wanted.empty() || wanted[v]) && frame.normals[v] != glm::vec3(0)) chosen[g].push_back(v);
    parallelFor(s.groups.size(), s.options.threads, [&](std::size_t g) {
        if (!chosen[g].empty()) results[g] = s.computeGroup(g, chosen[g], blockersNow, positions, frame);
    });
    frame.seconds.transform = prepared - start;
    for (std::size_t g = 0; g < s.groups.size(); ++g) {
        frame.computed += chosen[g].size();
        frame.listed += static_cast<double>(results[g].listed);
        frame.drawn += static_cast<double>(results[g].drawn);
        frame.seconds.rasterization += results[g].seconds.rasterization;
        frame.seconds.integration += results[g].seconds.integration;
        frame.seconds.transform += results[g].seconds.transform;
    }
    if (frame.computed > 0) {
        frame.listed /= static_cast<double>(frame.computed);
        frame.drawn /= static_cast<double>(frame.computed);
    }
    return frame;
}

}  // namespace nacre
