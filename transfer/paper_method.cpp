#include "transfer/paper_method.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "core/error.hpp"
#include "core/math.hpp"
#include "core/parallel.hpp"
#include "transfer/plane_table.hpp"
#include "transfer/receiver_groups.hpp"

namespace nacre {
namespace {

constexpr int kOrder = 4;
constexpr std::size_t kCoefficients = 25;
constexpr std::size_t kTask = 256;  ///< vertices that one copy of the coarse mesh serves

/// Of this thread: what waits for a processor isn't work.
double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Receiver receiverAt(const glm::vec3& point, const glm::vec3& normal) {
    const glm::vec3 side = std::abs(normal.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 tangent = glm::normalize(glm::cross(side, normal));
    return {point, tangent, glm::cross(normal, tangent), normal};
}

double harmonic(int l, int m, const glm::dvec3& s) {
    const double phi = std::atan2(s.y, s.x), p = harmonicOfHeight(l, std::abs(m), s.z);
    return m < 0 ? p * std::sin(-m * phi) : p * std::cos(m * phi);
}

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
                    mean += harmonic(l, m, s) / static_cast<double>(directions.size());
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

void addTriangle(const glm::uvec3& t, std::span<const glm::vec3> positions, const glm::vec3& centre,
                 BlockerList& list) {
    list.add(positions[t.x] - centre, positions[t.y] - centre, positions[t.z] - centre);
}

}  // namespace

struct PaperMethod::State {
    WeldedMesh mesh;
    PaperMethodOptions options;
    CornersOfVertices corners;
    std::vector<glm::uvec3> coarse;
    std::vector<std::uint32_t> vertices;           ///< in order of work
    std::vector<std::vector<std::uint32_t>> near;  ///< [vertex] triangles of the mesh
    std::size_t mostNear = 0;
    std::shared_ptr<const PlaneTable> table;
    MaskKernel culling = maskKernel(kDiskSize);
    DiskKernel kernel = diskKernel();
    Integral integral;
    HarmonicRotation rotation{kOrder};

    State(WeldedMesh m, std::span<const glm::vec3> rest, const PaperMethodOptions& o);
    void findNear();
    TaskResult computeTask(std::span<const std::uint32_t> of, const BlockerList& coarseList, const glm::vec3& centre,
                           std::span<const glm::vec3> positions, TransferFrame& frame) const;
};

PaperMethod::State::State(WeldedMesh m, std::span<const glm::vec3> rest, const PaperMethodOptions& o)
    : mesh(std::move(m)),
      options(o),
      corners(cornersOfVertices(mesh.triangles, mesh.vertexCount())),
      coarse(makeBlockerLevels(mesh, rest, {o.coarse}).levels.back().triangles),
      near(mesh.vertexCount()),
      integral(integralOf(o.sampledBlocks)) {
    if (options.sides == BlockingSides::Auto) options.sides = mesh.closed ? BlockingSides::Front : BlockingSides::Both;
    if (options.table > 0) table = planeTable(options.table, options.threads);
    for (const std::vector<std::uint32_t>& group :
         groupReceivers(rest, vertexNormals(mesh.triangles, corners, rest), kLanes))
        vertices.insert(vertices.end(), group.begin(), group.end());
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
            reached.clear();
            for (const std::uint32_t t : near[v])
                for (int c = 0; c < 3; ++c) reached.push_back(mesh.triangles[t][c]);
            std::sort(reached.begin(), reached.end());
            reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
        }
        mostNear = std::max(mostNear, near[v].size());
    }
}

TaskResult PaperMethod::State::computeTask(std::span<const std::uint32_t> of, const BlockerList& coarseList,
                                           const glm::vec3& centre, std::span<const glm::vec3> positions,
                                           TransferFrame& frame) const {
    TaskResult result;
    double before = now();  // read by the sixteen vertices, since that takes time too: culling counts as rasterization
    const auto lap = [&](double& seconds) {
        const double here = now();
        seconds += here - before;
        before = here;
    };
    BlockerList list = coarseList;
    const bool bothSides = options.sides == BlockingSides::Both;
    const std::size_t room = list.count + mostNear + 2 * kLanes;
    std::vector<std::uint32_t> indices(room * kLanes);
    for (std::size_t first = 0; first < of.size(); first += kLanes) {
        const std::size_t used = std::min<std::size_t>(kLanes, of.size() - first);
        Receiver receivers[kLanes];
        DiskMask masks[kLanes];
        float local[kLanes * kCoefficients], world[kLanes * kCoefficients];
        for (std::size_t i = 0; i < used; ++i) {
            const std::uint32_t v = of[first + i];
            receivers[i] = receiverAt(positions[v] - centre, frame.normals[v]);
            list.count = coarseList.count;
            for (const std::uint32_t t : near[v]) addTriangle(mesh.triangles[t], positions, centre, list);
            const int count = culling.cull(list, receivers[i], 0, bothSides, indices.data());
            result.listed += static_cast<double>(list.count);
            result.drawn += count;
            kernel.draw(table.get(), list.byTriangle.data(), receivers[i], bothSides, indices.data(), count, masks[i]);
        }
        lap(result.seconds.rasterization);
        for (std::size_t i = 0; i < used; ++i) {
            float hidden[2 * kLanes];
            kernel.integrate(integral.blocks, masks[i], hidden);
            for (std::size_t c = 0; c < kCoefficients; ++c)
                local[i * kCoefficients + c] = static_cast<float>(integral.open[c]) - hidden[c];
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
    glm::vec3 low(1e30f), high(-1e30f);
    for (const glm::vec3& p : positions) {
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
                "paper's method: positions that are not finite");
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const double start = now();
    TransferFrame frame;
    frame.coefficients.assign(positions.size() * kCoefficients, 0);
    frame.normals = vertexNormals(s.mesh.triangles, s.corners, positions, s.options.threads);
    const glm::vec3 centre = 0.5f * (low + high);
    BlockerList coarse;
    coarse.start(s.coarse.size() + s.mostNear);
    for (const glm::uvec3& t : s.coarse) addTriangle(t, positions, centre, coarse);
    std::vector<std::uint32_t> chosen;
    for (const std::uint32_t v : s.vertices)
        if (frame.normals[v] != glm::vec3(0)) chosen.push_back(v);
    frame.seconds.transform = now() - start;
    frame.computed = chosen.size();
    std::vector<TaskResult> results((chosen.size() + kTask - 1) / kTask);
    parallelFor(results.size(), s.options.threads, [&](std::size_t task) {
        const std::size_t first = task * kTask;
        const std::span<const std::uint32_t> all = chosen;
        results[task] =
            s.computeTask(all.subspan(first, std::min(kTask, all.size() - first)), coarse, centre, positions, frame);
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
