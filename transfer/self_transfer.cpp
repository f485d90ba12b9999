#include "transfer/self_transfer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "transfer/blocker_lists.hpp"
#include "transfer/thread_seconds.hpp"
#include "transfer/vertex_detail.hpp"

namespace nacre {
namespace {

constexpr std::size_t kGroup = kLanes;   ///< vertices that share a list
constexpr std::size_t kTimedGroups = 8;  ///< one of so many is timed

struct GroupResult {
    std::size_t listed = 0, drawn = 0;
    TransferSeconds seconds;
};

/// What a thread keeps from group to group.
struct Scratch {
    BlockerLists::Room lists;
    SilhouetteMesh::Seen seen;
    std::vector<std::int16_t> layers;
    std::vector<std::uint32_t> masks;
    std::vector<float> local, world, sums;
    std::vector<Receiver> receivers;
};

/// About the first vertex and with an extent of 1: far from the origin floats are coarse, and they end.
std::vector<glm::vec3> normalized(std::span<const glm::vec3> given) {
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (const glm::vec3& p : given) {
        low = glm::min(low, glm::dvec3(p));
        high = glm::max(high, glm::dvec3(p));
    }
    if (given.empty()) return {};
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    std::vector<glm::vec3> out;
    out.reserve(given.size());
    const double scale = extent > 0 ? 1 / extent : 1;
    for (const glm::vec3& p : given) out.emplace_back(scale * (glm::dvec3(p) - glm::dvec3(given[0])));
    return out;
}

}  // namespace

struct SelfTransfer::State {
    WeldedMesh mesh;
    SelfTransferOptions options;
    CornersOfVertices corners;
    MovingLevels levels;
    BlockingParts parts;
    std::vector<std::vector<std::uint32_t>> groups;
    float nearby = 0;                   ///< radii; infinity: all is near
    std::vector<VertexDetail> details;  ///< [group]
    SilhouetteMesh silhouettes;
    BlockerLists lists;
    SilhouetteKernel kernel;
    BlockerKernel blockerKernels;
    MaskKernel maskKernels;
    std::shared_ptr<const MaskRows> rows;
    std::shared_ptr<const MaskIntegrals> integrals;
    HarmonicRotation rotation;
    std::vector<double> open;
    std::mutex spareMutex;
    std::vector<std::unique_ptr<FrameBlockers>> spare;  ///< room of earlier frames: one a call at a time

    State(WeldedMesh m, std::span<const glm::vec3> rest, const SelfTransferOptions& o);
    std::unique_ptr<FrameBlockers> takeSpare();
    void keepSpare(std::unique_ptr<FrameBlockers> blockers);
    void makeGroups(std::span<const glm::vec3> rest, std::span<const VertexDetail> detailsOf);
    std::vector<VertexDetail> measureDetail(const SelfTransfer& transfer, std::span<const glm::vec3> rest,
                                            std::span<const std::vector<glm::vec3>> poses);
    SilhouetteMesh makeSilhouettes(std::span<const glm::vec3> rest) const;
    std::size_t listBlockers(const FrameBlockers& blockers, const GroupBounds& bounds, std::size_t group,
                             const BlockerSets& sets, Scratch& scratch) const;
    std::size_t setWords() const { return (kLanes * silhouettes.clusterCount() + 63) / 64; }
    std::size_t draw(std::size_t lane, const SilhouetteMesh::Frame& frame, Scratch& scratch) const;
    GroupResult computeGroup(std::size_t group, std::span<const std::uint32_t> vertices, const FrameBlockers& blockers,
                             std::span<const glm::vec3> positions, const MaskUse& use, const BlockerSets& sets,
                             TransferFrame& frame) const;
};

SelfTransfer::State::State(WeldedMesh m, std::span<const glm::vec3> rest, const SelfTransferOptions& o)
    : mesh(std::move(m)),
      options(o),
      corners(cornersOfVertices(mesh.triangles, mesh.vertexCount())),
      levels(makeBlockerLevels(mesh, rest, {o.coarse.value_or(usualCoarse(mesh.triangles.size()))}),
             mesh.vertexCount()),
      parts(blockingParts(mesh, rest, o.sides)),
      silhouettes(makeSilhouettes(rest)),
      lists(levels, silhouettes),
      kernel(silhouetteKernel(o.mask, o.vectors)),
      blockerKernels(blockerKernel(o.vectors)),
      maskKernels(maskKernel(o.mask, o.vectors)),
      rows(maskRows(o.mask)),
      integrals(maskIntegrals(o.mask, o.order)),
      rotation(o.order),
      open(openTransfer(o.order)) {
    options.sides = parts.sides;
    options.coarse = o.coarse.value_or(usualCoarse(mesh.triangles.size()));
    options.nearby = o.nearby.value_or(usualNearby(o.mask));
    nearby = *options.nearby > 0 ? static_cast<float>(*options.nearby) : std::numeric_limits<float>::infinity();
    makeGroups(rest, std::vector<VertexDetail>(rest.size(), VertexDetail::ByAngle));
}

SilhouetteMesh SelfTransfer::State::makeSilhouettes(std::span<const glm::vec3> rest) const {
    const BackSides inner = parts.hasShells || parts.sides == BlockingSides::Fine ? BackSides::Inside : BackSides::None;
    std::vector<std::vector<glm::uvec3>> triangles;
    std::vector<std::vector<BackSides>> backs(levels.levelCount());
    for (std::size_t l = 0; l < levels.levelCount(); ++l) {
        triangles.push_back(levels.triangles(l));
        for (const glm::uvec3& t : levels.vertexTriangles(l))
            backs[l].push_back(parts.sheets[t.x] ? BackSides::All : l == 0 ? inner : BackSides::None);
    }
    return SilhouetteMesh(triangles, levels.unpushed(rest), backs, levels.patchesOfTriangles());
}

/// Vertices that see backs, and those that see other levels, are in groups of their own.
/// \param detailsOf  [vertex]
void SelfTransfer::State::makeGroups(std::span<const glm::vec3> rest, std::span<const VertexDetail> detailsOf) {
    const std::vector<glm::vec3> normals = vertexNormals(mesh.triangles, corners, rest);
    groups.clear();
    details.clear();
    for (const int inside : {0, 1})
        for (const VertexDetail detail : {VertexDetail::Coarsest, VertexDetail::ByAngle, VertexDetail::Fine}) {
            std::vector<glm::vec3> ofKind = normals;
            for (std::size_t v = 0; v < ofKind.size(); ++v)
                if (parts.inside[v] != inside || detailsOf[v] != detail) ofKind[v] = glm::vec3(0);
            for (std::vector<std::uint32_t>& group : groupReceivers(rest, ofKind, kGroup)) {
                groups.push_back(std::move(group));
                details.push_back(detail);
            }
        }
    lists.setGroups(groups, mesh, corners, parts, options.rings);
}

std::unique_ptr<FrameBlockers> SelfTransfer::State::takeSpare() {
    const std::lock_guard lock(spareMutex);
    if (spare.empty()) return std::make_unique<FrameBlockers>();
    std::unique_ptr<FrameBlockers> out = std::move(spare.back());
    spare.pop_back();
    return out;
}

void SelfTransfer::State::keepSpare(std::unique_ptr<FrameBlockers> blockers) {
    const std::lock_guard lock(spareMutex);
    spare.push_back(std::move(blockers));
}

/// What may block some vertex of the group. \return  triangles
std::size_t SelfTransfer::State::listBlockers(const FrameBlockers& blockers, const GroupBounds& bounds,
                                              std::size_t group, const BlockerSets& sets, Scratch& scratch) const {
    std::vector<std::uint32_t>& members = scratch.seen.members;
    std::optional<float> angle;
    if (details[group] != VertexDetail::Coarsest)
        angle = static_cast<float>(options.lodAngle) * (details[group] == VertexDetail::Fine ? kFineAngle : 1);
    std::size_t listed = lists.list(group, bounds, angle, blockers, blockerKernels, scratch.lists, members);
    if (!sets.visible.empty())
        for (std::size_t c = 0; c < members.size(); ++c)
            members[c] &=
                static_cast<std::uint32_t>(sets.visible[group * setWords() + c / 4] >> c % 4 * kLanes) & 0xffffu;
    for (const std::uint32_t some : members)
        if (some) listed += static_cast<std::size_t>(std::popcount(some));
    return listed;
}

/// \return  edges drawn
std::size_t SelfTransfer::State::draw(std::size_t lane, const SilhouetteMesh::Frame& frame, Scratch& scratch) const {
    SilhouetteMesh::Seen& seen = scratch.seen;
    scratch.layers.assign(layerCounts(options.mask), 0);
    kernel.add(*rows, frame.edges.data(), scratch.receivers[lane], &seen.dealt.items[seen.dealt.room * lane],
               seen.dealt.counts[lane], scratch.layers.data());
    kernel.finish(scratch.layers.data(), seen.poles[lane], &scratch.masks[maskWords(options.mask) * lane]);
    return seen.dealt.counts[lane];
}

GroupResult SelfTransfer::State::computeGroup(std::size_t group, std::span<const std::uint32_t> vertices,
                                              const FrameBlockers& blockers, std::span<const glm::vec3> positions,
                                              const MaskUse& use, const BlockerSets& sets, TransferFrame& frame) const {
    static thread_local Scratch scratch;
    GroupResult result;
    // Asking for the time costs as much as a vertex: every eighth group stands for the others.
    const bool timed = group % kTimedGroups == 0;
    const auto now = [&] { return timed ? threadSeconds() : 0.0; };
    const double start = now();
    scratch.receivers.resize(vertices.size());
    std::uint32_t inside = 0;
    std::array<std::span<const std::uint32_t>, kLanes> meeting;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::uint32_t first = corners.first[vertices[i]];
        meeting[i] = std::span(corners.order).subspan(first, corners.first[vertices[i] + 1] - first);
        scratch.receivers[i] = receiverAt(positions[vertices[i]], frame.normals[vertices[i]]);
        inside |= std::uint32_t{parts.inside[vertices[i]]} << i;
    }
    const GroupBounds bounds = boundsOfGroup(vertices, positions, frame.normals);
    result.listed = listBlockers(blockers, bounds, group, sets, scratch) * vertices.size();
    silhouettes.see(blockers.silhouettes, kernel, scratch.receivers, boxOfGroup(groups[group], positions), meeting,
                    inside, nearby, scratch.seen);
    if (!sets.drawn.empty())
        for (std::size_t c = 0; c < silhouettes.clusterCount(); ++c)
            sets.drawn[group * setWords() + c / 4] |= std::uint64_t{scratch.seen.blocking(c)} << c % 4 * kLanes;
    const double listed = now();
    const std::size_t words = maskWords(options.mask);
    scratch.masks.resize(words * vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) result.drawn += draw(i, blockers.silhouettes, scratch);
    if (use)
        for (std::size_t i = 0; i < vertices.size(); ++i)
            use(vertices[i], scratch.receivers[i], std::span(scratch.masks).subspan(words * i, words));
    const double drawn = now();
    const std::size_t size = static_cast<std::size_t>((options.order + 1) * (options.order + 1));
    scratch.local.assign(size * kLanes, 0);
    scratch.world.resize(size * vertices.size());
    scratch.sums.resize(static_cast<std::size_t>(2 * kLanes * integrals->groups));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        maskKernels.integrate(*integrals, &scratch.masks[words * i], scratch.sums.data());
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

/// At rest and in the poses.
std::vector<VertexDetail> SelfTransfer::State::measureDetail(const SelfTransfer& transfer,
                                                             std::span<const glm::vec3> rest,
                                                             std::span<const std::vector<glm::vec3>> poses) {
    MeasuredDetail measured(rest.size());
    const auto found = [&](std::span<const glm::vec3> positions, VertexDetail detail) {
        std::fill(details.begin(), details.end(), detail);
        return transfer.compute(positions).coefficients;
    };
    const auto add = [&](std::span<const glm::vec3> positions) {
        const std::vector<float> byAngle = found(positions, VertexDetail::ByAngle);
        if (options.lodError > 0)
            measured.add(byAngle, found(positions, VertexDetail::Coarsest), open[0]);
        else
            measured.add(byAngle, byAngle, open[0]);
    };
    add(rest);
    for (const std::vector<glm::vec3>& pose : poses)
        if (!std::ranges::equal(pose, rest)) add(pose);
    return measured.within(options.lodError);
}

SelfTransfer::SelfTransfer(WeldedMesh mesh, std::span<const glm::vec3> rest, const SelfTransferOptions& options,
                           std::span<const std::vector<glm::vec3>> poses) {
    require(options.rings == 1 || options.rings == 2, "transfer: expected 1 or 2 rings");
    require(std::isfinite(options.lodAngle) && options.lodAngle >= 0, "transfer: expected an angle of 0 or more");
    require(!options.nearby || *options.nearby == 0 || (*options.nearby >= 1 && std::isfinite(*options.nearby)),
            "transfer: expected radii of 1 or more, or 0");
    require(std::isfinite(options.lodError) && options.lodError >= 0, "transfer: expected an error of 0 or more");
    require(rest.size() == mesh.vertexCount(), "transfer: expected a position a vertex");
    state_ = std::make_unique<State>(std::move(mesh), normalized(rest), options);
    State& s = *state_;
    if (rest.empty() || (s.levels.levelCount() == 1 && !s.parts.hasShells)) return;
    if (s.parts.hasShells) {
        const std::vector<float> withBacks = compute(rest).coefficients;
        std::fill(s.parts.inside.begin(), s.parts.inside.end(), std::uint8_t{0});
        findInside(s.mesh, withBacks, compute(rest).coefficients, s.open[0], s.parts);
    }
    if (s.levels.levelCount() == 1) return;
    s.makeGroups(normalized(rest), s.measureDetail(*this, rest, poses));
}

SelfTransfer::~SelfTransfer() = default;
SelfTransfer::SelfTransfer(SelfTransfer&&) noexcept = default;

const WeldedMesh& SelfTransfer::mesh() const { return state_->mesh; }
const SelfTransferOptions& SelfTransfer::options() const { return state_->options; }
std::size_t SelfTransfer::coarseTriangles() const { return state_->levels.coarsestTriangles(); }

std::uint32_t SelfTransfer::groupCount() const { return static_cast<std::uint32_t>(state_->groups.size()); }
std::uint32_t SelfTransfer::placeCount() const {
    return static_cast<std::uint32_t>(kLanes * state_->silhouettes.clusterCount());
}

std::size_t SelfTransfer::bytes() const {
    const State& s = *state_;
    const std::size_t vertices = s.mesh.vertexCount();
    std::size_t sum = bytesOf(s.mesh.weldOf) + bytesOf(s.mesh.firstOf) + bytesOf(s.mesh.triangles) + s.corners.bytes() +
                      s.levels.bytes() + bytesOf(s.parts.sheets) + bytesOf(s.parts.inside) + bytesOf(s.groups) +
                      bytesOf(s.details) + s.lists.bytes() + s.silhouettes.bytes();
    for (const std::unique_ptr<FrameBlockers>& blockers : s.spare) sum += blockers->bytes();
    return sum + vertices * (2 * sizeof(glm::vec3) + s.open.size() * s.open.size() * sizeof(float));
}

std::uint64_t SelfTransfer::key() const {
    std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a by words
    const auto add = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3ull; };
    const SelfTransferOptions& o = state_->options;
    add(*o.coarse);
    add(static_cast<std::uint64_t>(o.rings));
    add(static_cast<std::uint64_t>(o.sides));
    add(std::bit_cast<std::uint64_t>(o.lodAngle));
    for (std::size_t g = 0; g < state_->groups.size(); ++g) {
        add(static_cast<std::uint64_t>(state_->details[g]));
        for (const std::uint32_t v : state_->groups[g]) add(v);
    }
    for (const glm::uvec3& t : state_->mesh.triangles)
        for (int c = 0; c < 3; ++c) add(t[c]);
    for (std::size_t p = 0; p < state_->levels.patches().size(); ++p)
        for (const std::vector<std::uint32_t>& level : state_->levels.patches()[p].triangles)
            for (const std::uint32_t t : level) add(t);
    return hash;
}

TransferFrame SelfTransfer::compute(std::span<const glm::vec3> given, std::span<const std::uint8_t> wanted,
                                    const MaskUse& use, const BlockerSets& sets) const {
    State& s = *state_;
    require(given.size() == s.mesh.vertexCount(), "transfer: expected a position a vertex");
    require(wanted.empty() || wanted.size() == given.size(), "transfer: expected one mark a vertex");
    const std::size_t setWords = s.groups.size() * s.setWords();
    require((sets.visible.empty() || sets.visible.size() == setWords) &&
                (sets.drawn.empty() || sets.drawn.size() == setWords),
            "transfer: expected sets of blockers of this mesh");
    for (const glm::vec3& p : given)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
                "transfer: positions that are not finite");
    const double start = threadSeconds();
    const std::vector<glm::vec3> positions = normalized(given);
    TransferFrame frame;
    frame.coefficients.assign(
        positions.size() * static_cast<std::size_t>((s.options.order + 1) * (s.options.order + 1)), 0);
    frame.normals = vertexNormals(s.mesh.triangles, s.corners, positions, s.options.threads);
    std::unique_ptr<FrameBlockers> blockers = s.takeSpare();
    s.levels.place(positions, s.options.threads, *blockers);
    s.silhouettes.place(blockers->points, s.kernel, s.options.threads, blockers->silhouettes);
    const double prepared = threadSeconds();
    std::vector<std::vector<std::uint32_t>> chosen(s.groups.size());
    std::vector<GroupResult> results(s.groups.size());
    for (std::size_t g = 0; g < s.groups.size(); ++g)
        for (const std::uint32_t v : s.groups[g])
            if ((wanted.empty() || wanted[v]) && frame.normals[v] != glm::vec3(0)) chosen[g].push_back(v);
    parallelFor(s.groups.size(), s.options.threads, [&](std::size_t g) {
        if (!chosen[g].empty()) results[g] = s.computeGroup(g, chosen[g], *blockers, positions, use, sets, frame);
    });
    s.keepSpare(std::move(blockers));
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
