#include "transfer/paper_method.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/math.hpp"
#include "core/parallel.hpp"
#include "transfer/blocker_kernel.hpp"
#include "transfer/plane_table.hpp"
#include "transfer/receiver_groups.hpp"
#include "transfer/thread_seconds.hpp"

namespace nacre {
namespace {

constexpr int kOrder = 4;
constexpr std::size_t kCoefficients = 25;
constexpr std::size_t kTask = 256;  ///< vertices

/// Blocks' weights and what an open hemisphere has.
struct Integral {
    DiskIntegrals blocks{};
    std::vector<double> open = std::vector<double>(kCoefficients, 0);
};

Integral integralOf(bool sampledBlocks) {
    const DiskGrid& grid = diskGrid();
    Integral out;
    for (std::size_t block = 0; block < kDiskBlocks; ++block) {
        std::vector<glm::dvec3> directions;
        glm::dvec3 sum(0);
        for (int bit = 0; bit < 16; ++bit) {
            const int i = static_cast<int>(block % 8) * 4 + bit % 4, j = static_cast<int>(block / 8) * 4 + bit / 4;
            if (!grid.inside.at(i, j)) continue;
            directions.emplace_back(grid.x[i], grid.y[j], grid.z[j][i]);
            sum += directions.back();
        }
        const double bits = static_cast<double>(directions.size());
        if (bits == 0) continue;
        if (sampledBlocks) directions = {glm::normalize(sum)};
        std::size_t c = 0;
        for (int l = 0; l <= kOrder; ++l)
            for (int m = -l; m <= l; ++m, ++c) {
                double mean = 0;
                for (const glm::dvec3& s : directions)
                    mean += harmonicAt(l, m, s.z, std::atan2(s.y, s.x)) / static_cast<double>(directions.size());
                out.blocks.perBit[block][c] = static_cast<float>(mean / grid.count);
                out.open[c] += mean * bits / grid.count;
            }
    }
    if (sampledBlocks) return out;
    const std::vector<double> zonal = openTransfer(kOrder);
    std::fill(out.open.begin(), out.open.end(), 0.0);
    for (std::size_t l = 0; l <= kOrder; ++l) out.open[l * l + l] = zonal[l];
    return out;
}

struct TaskResult {
    double listed = 0, drawn = 0;
    TransferSeconds seconds;
};

/// One frame's blockers: rows of the coarse mesh, then of the mesh; the coarse ones by columns too.
struct BlockersNow {
    std::vector<BlockerRow> rows;
    ListedBlockers coarse;
};

void addRows(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
             std::vector<BlockerRow>& rows) {
    for (const glm::uvec3& t : triangles) rows.push_back(blockerRow(positions[t.x], positions[t.y], positions[t.z]));
}

ListedBlockers columnsOf(std::span<const BlockerRow> rows, bool bothSides) {
    ListedBlockers out;
    out.count = rows.size();
    const std::size_t padded = (rows.size() + kLanes - 1) / kLanes * kLanes;
    for (std::vector<float>& column : out.columns) column.resize(padded);
    for (std::size_t t = 0; t < rows.size(); ++t) {
        for (std::size_t k = 0; k < 9; ++k) out.columns[k][t] = rows[t].corners[k];
        for (std::size_t k = 0; k < 3; ++k) out.columns[9 + k][t] = rows[t].normal[k];
        out.columns[12][t] = bothSides ? kAnyOffset : rows[t].offset;
    }
    return out;
}

/// BlockerKernel::cull of one.
bool blocks(const BlockerRow& row, const Receiver& receiver, bool bothSides) {
    const glm::vec3 &p = receiver.point, &n = receiver.normal;
    if (!bothSides && row.normal[0] * p.x + row.normal[1] * p.y + row.normal[2] * p.z <= row.offset) return false;
    const float* c = row.corners;
    const auto height = [&](int k) { return n.x * c[k] + n.y * c[k + 1] + n.z * c[k + 2]; };
    return std::max({height(0), height(3), height(6)}) > glm::dot(n, p);
}

}  // namespace

struct PaperMethod::State {
    WeldedMesh mesh;
    PaperMethodOptions options;
    CornersOfVertices corners;
    std::vector<glm::uvec3> coarse;
    std::vector<std::uint32_t> coarseOf;               ///< of each vertex: the coarse triangle that stands for it
    std::vector<std::uint32_t> vertices;               ///< in order of work
    std::vector<std::vector<std::uint32_t>> near;      ///< [vertex] triangles of the mesh
    std::vector<std::vector<std::uint32_t>> replaced;  ///< [vertex] coarse triangles that those stand in for
    std::size_t mostNear = 0;
    std::shared_ptr<const PlaneTable> table;
    BlockerKernel culling = blockerKernel();
    DiskKernel kernel = diskKernel();
    Integral integral;
    HarmonicRotation rotation{kOrder};

    State(WeldedMesh m, std::span<const glm::vec3> rest, const PaperMethodOptions& o);
    void findNear();
    TaskResult computeTask(std::span<const std::uint32_t> of, const BlockersNow& blockers,
                           std::span<const glm::vec3> positions, TransferFrame& frame) const;
};

PaperMethod::State::State(WeldedMesh m, std::span<const glm::vec3> rest, const PaperMethodOptions& o)
    : mesh(std::move(m)),
      options(o),
      corners(cornersOfVertices(mesh.triangles, mesh.vertexCount())),
      near(mesh.vertexCount()),
      replaced(mesh.vertexCount()),
      integral(integralOf(o.sampledBlocks)) {
    if (options.sides == BlockingSides::Auto) options.sides = mesh.closed ? BlockingSides::Front : BlockingSides::Both;
    if (options.table > 0) table = planeTable(options.table, options.threads);
    for (const std::vector<std::uint32_t>& group :
         groupReceivers(rest, vertexNormals(mesh.triangles, corners, rest), kLanes))
        vertices.insert(vertices.end(), group.begin(), group.end());
    BlockerLevels::Level level = makeBlockerLevels(mesh, rest, {o.coarse}).levels.back();
    coarse = std::move(level.triangles);
    coarseOf = std::move(level.triangleOf);
    if (coarse.size() < mesh.triangles.size()) findNear();
}

void PaperMethod::State::findNear() {
    for (std::uint32_t v = 0; v < near.size(); ++v) {
        std::vector<std::uint32_t> reached = {v};
        for (int ring = 0; ring < options.rings; ++ring) {
            for (const std::uint32_t r : reached)
                for (std::uint32_t i = corners.first[r]; i < corners.first[r + 1]; ++i)
                    near[v].push_back(corners.order[i] / 3);
            std::sort(near[v].begin(), near[v].end());
            near[v].erase(std::unique(near[v].begin(), near[v].end()), near[v].end());
            replaced[v].clear();
            for (const std::uint32_t r : reached) replaced[v].push_back(coarseOf[r]);
            reached.clear();
            for (const std::uint32_t t : near[v])
                for (int c = 0; c < 3; ++c) reached.push_back(mesh.triangles[t][c]);
            std::sort(reached.begin(), reached.end());
            reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
        }
        std::sort(replaced[v].begin(), replaced[v].end());
        replaced[v].erase(std::unique(replaced[v].begin(), replaced[v].end()), replaced[v].end());
        mostNear = std::max(mostNear, near[v].size());
    }
}

TaskResult PaperMethod::State::computeTask(std::span<const std::uint32_t> of, const BlockersNow& blockers,
                                           std::span<const glm::vec3> positions, TransferFrame& frame) const {
    TaskResult result;
    double before =
        threadSeconds();  // read by the sixteen vertices, since that takes time too: culling counts as rasterization
    const auto lap = [&](double& seconds) {
        const double here = threadSeconds();
        seconds += here - before;
        before = here;
    };
    const bool bothSides = options.sides == BlockingSides::Both;
    std::vector<std::uint32_t> indices(blockers.coarse.count + mostNear + 2 * kLanes),
        isReplaced(blockers.coarse.count, 0);
    for (std::size_t first = 0; first < of.size(); first += kLanes) {
        const std::size_t used = std::min<std::size_t>(kLanes, of.size() - first);
        Receiver receivers[kLanes];
        DiskMask masks[kLanes];
        float local[kLanes * kCoefficients] = {}, world[kLanes * kCoefficients];
        for (std::size_t i = 0; i < used; ++i) {
            const std::uint32_t v = of[first + i];
            receivers[i] = receiverAt(positions[v], frame.normals[v]);
            const std::size_t all = culling.cull(blockers.coarse, receivers[i], indices.data());
            std::uint32_t* const end = indices.data() + all;
            for (const std::uint32_t t : replaced[v]) isReplaced[t] = v + 1;
            std::uint32_t* last =
                std::remove_if(indices.data(), end, [&](std::uint32_t t) { return isReplaced[t] == v + 1; });
            for (const std::uint32_t t : near[v])
                if (blocks(blockers.rows[coarse.size() + t], receivers[i], bothSides))
                    *last++ = static_cast<std::uint32_t>(coarse.size()) + t;
            const auto count = static_cast<int>(last - indices.data());
            result.listed += static_cast<double>(blockers.coarse.count - replaced[v].size() + near[v].size());
            result.drawn += count;
            kernel.draw(table.get(), blockers.rows.data(), receivers[i], bothSides, indices.data(), count, masks[i]);
        }
        lap(result.seconds.rasterization);
        for (std::size_t i = 0; i < used; ++i) {
            float hidden[2 * kLanes];
            kernel.integrate(integral.blocks, masks[i], hidden);
            for (std::size_t c = 0; c < kCoefficients; ++c)
                local[c * kLanes + i] = static_cast<float>(integral.open[c]) - hidden[c];
        }
        rotation.turn(receivers, used, local, world);
        for (std::size_t i = 0; i < used; ++i)
            std::copy_n(world + i * kCoefficients, kCoefficients, &frame.coefficients[kCoefficients * of[first + i]]);
        lap(result.seconds.integration);
    }
    return result;
}

PaperMethod::PaperMethod(WeldedMesh mesh, std::span<const glm::vec3> rest, const PaperMethodOptions& options) {
    require(options.rings == 1 || options.rings == 2, "paper's method: expected 1 or 2 rings");
    require(options.table >= 0 && options.table <= 512, "paper's method: expected a table of 0 to 512");
    require(rest.size() == mesh.vertexCount(), "paper's method: expected a position a vertex");
    state_ = std::make_unique<State>(std::move(mesh), rest, options);
}
PaperMethod::~PaperMethod() = default;
PaperMethod::PaperMethod(PaperMethod&&) noexcept = default;

std::size_t PaperMethod::coarseTriangles() const { return state_->coarse.size(); }

TransferFrame PaperMethod::compute(std::span<const glm::vec3> positions) const {
    const State& s = *state_;
    require(positions.size() == s.mesh.vertexCount(), "paper's method: expected a position a vertex");
    for (const glm::vec3& p : positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
                "paper's method: positions that are not finite");
    const double start = threadSeconds();
    TransferFrame frame;
    frame.coefficients.assign(positions.size() * kCoefficients, 0);
    frame.normals = vertexNormals(s.mesh.triangles, s.corners, positions, s.options.threads);
    BlockersNow blockers;
    addRows(s.coarse, positions, blockers.rows);
    blockers.coarse = columnsOf(blockers.rows, s.options.sides == BlockingSides::Both);
    if (s.mostNear > 0) addRows(s.mesh.triangles, positions, blockers.rows);
    std::vector<std::uint32_t> chosen;
    for (const std::uint32_t v : s.vertices)
        if (frame.normals[v] != glm::vec3(0)) chosen.push_back(v);
    frame.seconds.transform = threadSeconds() - start;
    frame.computed = chosen.size();
    std::vector<TaskResult> results((chosen.size() + kTask - 1) / kTask);
    parallelFor(results.size(), s.options.threads, [&](std::size_t task) {
        const std::size_t first = task * kTask;
        const std::span<const std::uint32_t> all = chosen;
        results[task] =
            s.computeTask(all.subspan(first, std::min(kTask, all.size() - first)), blockers, positions, frame);
    });
    for (const TaskResult& r : results) {
        frame.listed += r.listed / static_cast<double>(frame.computed);
        frame.drawn += r.drawn / static_cast<double>(frame.computed);
        frame.seconds.rasterization += r.seconds.rasterization;
        frame.seconds.integration += r.seconds.integration;
        frame.seconds.transform += r.seconds.transform;
    }
    return frame;
}

}  // namespace nacre
