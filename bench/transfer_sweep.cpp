#include "bench/transfer_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "bench/embree_transfer.hpp"
#include "bench/environment_sweep.hpp"
#include "reference/transfer_trace.hpp"

namespace nacre::bench {
namespace {

constexpr std::size_t kCoefficients = 25;

/// Vertices of one frame and their transfer by rays.
struct Truth {
    std::vector<std::uint32_t> vertices;
    std::vector<double> coefficients;
};

std::vector<float> asFloats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

/// Errors over all frames together. \param found  [frame] the sampled vertices' coefficients
TransferError errorOver(const std::vector<std::vector<float>>& found, const std::vector<Truth>& truths) {
    std::vector<float> all;
    std::vector<double> truth;
    for (std::size_t f = 0; f < truths.size(); ++f) {
        all.insert(all.end(), found[f].begin(), found[f].end());
        truth.insert(truth.end(), truths[f].coefficients.begin(), truths[f].coefficients.end());
    }
    return transferError(all, truth, kCoefficients);
}

/// Every so-many-th vertex that has a normal; the first of them moves from frame to frame.
std::vector<Truth> truthsOf(const TransferMesh& mesh, std::size_t sampled, std::size_t rays) {
    std::vector<Truth> out;
    const CornersOfVertices corners = cornersOfVertices(mesh.mesh.triangles, mesh.mesh.vertexCount());
    for (const std::vector<glm::vec3>& frame : mesh.frames) {
        const std::vector<glm::vec3> normals = vertexNormals(mesh.mesh.triangles, corners, frame);
        Truth truth;
        const std::size_t step = std::max<std::size_t>(1, frame.size() / sampled);
        for (std::size_t v = out.size() * step / mesh.frames.size(); v < frame.size(); v += step)
            if (normals[v] != glm::vec3(0)) truth.vertices.push_back(static_cast<std::uint32_t>(v));
        truth.coefficients = tracedTransfer(mesh.mesh.triangles, frame, normals, truth.vertices, 4, rays);
        out.push_back(std::move(truth));
    }
    return out;
}

std::vector<float> sampledOf(const TransferFrame& frame, const Truth& truth) {
    std::vector<float> out;
    for (const std::uint32_t v : truth.vertices)
        out.insert(out.end(), &frame.coefficients[kCoefficients * v],
                   &frame.coefficients[kCoefficients * v] + kCoefficients);
    return out;
}

double wallSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

SelfTransferOptions quickTransfer() { return {.coarse = 500, .lodError = 0.15, .nearby = 1.5}; }

SelfTransferOptions largeTransfer() { return {.coarse = 500, .lodAngle = 0.3, .lodError = 0.02}; }

SelfTransferOptions fastTransfer() { return {.coarse = 0}; }

SelfTransferOptions qualityTransfer() { return {.mask = 64, .coarse = 0}; }

std::string text(const SelfTransferOptions& o) {
    const std::string sides = o.sides == BlockingSides::Auto    ? ""
                              : o.sides == BlockingSides::Front ? ", front sides"
                              : o.sides == BlockingSides::Fine  ? ", both sides of the mesh itself"
                                                                : ", both sides";
    const std::string nearby = o.nearby ? fmt::format(", nearby {:g}", *o.nearby) : "";
    if (o.coarse == 0u) return fmt::format("mask {}, no levels{}{}", o.mask, nearby, sides);
    return fmt::format("mask {}, coarse {}, angle {:g}, error {:g}, rings {}{}{}", o.mask,
                       o.coarse.value_or(kUsualCoarse), o.lodAngle, o.lodError, o.rings, nearby, sides);
}

std::string text(const PaperMethodOptions& o) {
    const std::string planes = o.table > 0 ? fmt::format("table {}", o.table) : "exact planes";
    if (o.coarse == 0) return planes + ", no levels";
    return fmt::format("{}, coarse {}, rings {}", planes, o.coarse, o.rings);
}

TransferContender ours(const TransferMesh& mesh, const SelfTransferOptions& options) {
    const auto method = std::make_shared<SelfTransfer>(mesh.mesh, mesh.rest, options, mesh.poses);
    return {"nacre", text(options), [method](std::span<const glm::vec3> p) { return method->compute(p); }};
}

TransferContender papers(const TransferMesh& mesh, const PaperMethodOptions& options) {
    const auto method = std::make_shared<PaperMethod>(mesh.mesh, mesh.rest, options);
    return {options.sampledBlocks ? "HEMI" : "HEMI, blocks' means", text(options),
            [method](std::span<const glm::vec3> p) { return method->compute(p); }};
}

TransferContender embree(const TransferMesh& mesh, std::size_t rays) {
    const auto method = std::make_shared<EmbreeTransfer>(mesh.mesh, rays);
    return {"Embree", fmt::format("{} rays", rays),
            [method](std::span<const glm::vec3> p) { return method->compute(p); }};
}

std::vector<TransferMeasurement> measureTransfer(const TransferMesh& mesh,
                                                 const std::vector<TransferContender>& contenders,
                                                 const TransferSweepOptions& options) {
    report(options.progress, fmt::format("transfer of {}: rays", mesh.name), 0);
    const std::vector<Truth> truths = truthsOf(mesh, options.sampled, options.rays);
    std::vector<std::vector<float>> second;
    for (const Truth& t : truthsOf(mesh, options.sampled, options.rays * 3 / 4))
        second.push_back(asFloats(t.coefficients));
    const double noise = errorOver(second, truths).mean, frames = static_cast<double>(mesh.frames.size());
    std::vector<TransferMeasurement> out;
    for (const TransferContender& c : contenders) {
        report(options.progress, fmt::format("transfer of {}: {}, {}", mesh.name, c.method, c.setting), 0);
        TransferMeasurement m;
        m.mesh = mesh.name, m.method = c.method, m.setting = c.setting;
        std::vector<std::vector<float>> found;
        for (std::size_t f = 0; f < truths.size(); ++f) {
            const TransferFrame frame = c.compute(mesh.frames[f]);
            found.push_back(sampledOf(frame, truths[f]));
            m.vertices = frame.computed;
            m.listed += frame.listed / frames;
            m.drawn += frame.drawn / frames;
            m.seconds = frame.seconds;
        }
        const TransferError error = errorOver(found, truths);
        m.error = error.mean, m.total = error.total, m.noise = noise;
        out.push_back(m);
    }
    std::vector<std::vector<double>> cpu(contenders.size()), wall(contenders.size());
    for (int repeat = 0; repeat < options.repeats; ++repeat)
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            if (repeat >= 3 && cpu[c][0] > 1) continue;
            report(options.progress,
                   fmt::format("transfer of {}: time {} of {}", mesh.name, repeat + 1, options.repeats), 0);
            contenders[c].compute(mesh.frames[0]);  // what another method has left in the caches is not its own
            const double cpuStart = processCpuSeconds(), wallStart = wallSeconds();
            for (const std::vector<glm::vec3>& frame : mesh.frames) contenders[c].compute(frame);
            cpu[c].push_back((processCpuSeconds() - cpuStart) / frames);
            wall[c].push_back((wallSeconds() - wallStart) / frames);
        }
    for (std::size_t c = 0; c < contenders.size(); ++c)
        out[c].cpuSeconds = median(cpu[c]), out[c].wallSeconds = median(wall[c]);
    return out;
}

std::vector<TransferMeasurement> sweepTransfer(const std::vector<TransferMesh>& meshes,
                                               const TransferSweepOptions& options) {
    std::vector<TransferMeasurement> out;
    for (const TransferMesh& mesh : meshes) {
        std::vector<TransferContender> all;
        const auto add = [&](int mask, std::size_t coarse, double angle, int rings = 1) {
            SelfTransferOptions o;
            o.mask = mask, o.coarse = coarse, o.lodAngle = angle, o.rings = rings;
            all.push_back(ours(mesh, o));
        };
        const double angle = SelfTransferOptions{}.lodAngle;
        for (const int mask : {16, 32, 64, 128}) {
            add(mask, 0, angle);
            add(mask, kUsualCoarse, angle);
        }
        for (const double nearby : {0.0, 1.0, 4.0})
            all.push_back(ours(mesh, {.mask = 32, .coarse = 0, .nearby = nearby}));
        if (!options.quick) {
            for (const double other : {0.05, 0.1, 0.15, 0.4, 0.6, 1.0}) add(32, kUsualCoarse, other);
            for (const double error : {0.0, 0.03, 0.2, 0.3})
                all.push_back(ours(mesh, {.mask = 32, .coarse = kUsualCoarse, .lodError = error}));
            for (const std::size_t coarse : {75, 150, 600}) add(32, coarse, angle);
            add(32, kUsualCoarse, angle, 2);
            for (const int table : {32, 64, 256, 0}) all.push_back(papers(mesh, {.table = table}));
            all.push_back(papers(mesh, {.rings = 1}));
            all.push_back(papers(mesh, {.coarse = 0}));
        }
        all.push_back(papers(mesh, {}));
        all.push_back(papers(mesh, {.sampledBlocks = false}));
        for (const std::size_t rays : {64, 128, 256, 512, 1024, 2048})
            if (!options.quick || rays <= 512) all.push_back(embree(mesh, rays));
        const std::vector<TransferMeasurement> some = measureTransfer(mesh, all, options);
        out.insert(out.end(), some.begin(), some.end());
    }
    return out;
}

double embreeSecondsAt(const std::vector<TransferMeasurement>& ofMesh, double error) {
    std::vector<const TransferMeasurement*> rays;
    for (const TransferMeasurement& m : ofMesh)
        if (m.method == "Embree" && m.error > 0) rays.push_back(&m);
    if (rays.size() < 2) return 0;
    std::sort(rays.begin(), rays.end(), [](auto* a, auto* b) { return a->error > b->error; });
    std::size_t i = 0;
    while (i + 2 < rays.size() && rays[i + 1]->error > error) ++i;
    const TransferMeasurement &a = *rays[i], &b = *rays[i + 1];
    const double along = std::log(error / a.error) / std::log(b.error / a.error);
    return a.cpuSeconds / static_cast<double>(a.vertices) * std::pow(b.cpuSeconds / a.cpuSeconds, along);
}

}  // namespace nacre::bench
