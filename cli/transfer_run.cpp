#include "cli/transfer_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <numeric>

#include "cli/output_file.hpp"
#include "core/error.hpp"
#include "reference/glossy_trace.hpp"
#include "shading/scene_bounds.hpp"
#include "transfer/glossy_transfer.hpp"
#include "transfer/paper_method.hpp"
#include "transfer/visible_sets.hpp"

namespace nacre::cli {

static bool allFinite(const std::vector<glm::vec3>& positions) {
    return std::all_of(positions.begin(), positions.end(), [](const glm::vec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    });
}

static void add(TransferRun& run, const TransferFrame& frame, double wallSeconds, double cpuSeconds) {
    const TransferSeconds& s = frame.seconds;
    run.wallSeconds += wallSeconds;
    run.seconds.rasterization += s.rasterization;
    run.seconds.integration += s.integration;
    run.seconds.transform += s.transform;
    run.seconds.other += std::max(0.0, cpuSeconds - s.rasterization - s.integration - s.transform);
    run.computed += frame.computed;
    run.listed += frame.listed * static_cast<double>(frame.computed);  // sums until all frames are done
    run.drawn += frame.drawn * static_cast<double>(frame.computed);
    const auto without = std::count(frame.normals.begin(), frame.normals.end(), glm::vec3(0));
    run.withoutNormal = std::max(run.withoutNormal, static_cast<std::size_t>(without));
}

namespace {

/// One of both methods.
class Method {
public:
    Method(const WeldedMesh& mesh, std::span<const glm::vec3> rest, const TransferPlan& plan,
           std::span<const std::vector<glm::vec3>> poses)
        : sides_(plan.options.sides), paperCoarse_(plan.options.coarse.value_or(PaperMethodOptions{}.coarse)) {
        const SelfTransferOptions& o = plan.options;
        if (o.sides == BlockingSides::Auto) sides_ = mesh.closed ? BlockingSides::Front : BlockingSides::Both;
        if (plan.lut)
            paper_.emplace(mesh, rest, PaperMethodOptions{*plan.lut, o.rings, paperCoarse_, o.sides, true, o.threads});
        else
            self_.emplace(mesh, rest, o, poses);
    }
    /// \param gloss  of the recording; none: matt
    void shine(const std::optional<RecordedGloss>& gloss, const SelfTransferOptions& o) {
        if (!gloss) return;
        gloss_ = gloss;
        lobe_.emplace(o.mask, o.order, MaskDetail::Bits, phongBrdf(static_cast<float>(gloss->exponent)));
    }
    TransferFrame compute(std::span<const glm::vec3> positions, std::span<const std::uint64_t> visible = {}) const {
        if (lobe_) return computeGlossy(*self_, positions, *lobe_, gloss_->specular, gloss_->eye);
        return paper_ ? paper_->compute(positions) : self_->compute(positions, {}, {}, {visible, {}});
    }
    const SelfTransfer& self() const { return *self_; }  ///< unless the paper's
    std::size_t bytes() const { return self_ ? self_->bytes() : 0; }
    std::size_t coarse() const { return paper_ ? paperCoarse_ : *self_->options().coarse; }
    std::size_t coarseTriangles() const { return paper_ ? paper_->coarseTriangles() : self_->coarseTriangles(); }

    BlockingSides sides() const { return paper_ ? sides_ : self_->options().sides; }  ///< resolved

private:
    BlockingSides sides_;  ///< of the paper's method, resolved as it does
    std::optional<SelfTransfer> self_;
    std::size_t paperCoarse_;
    std::optional<PaperMethod> paper_;
    std::optional<RecordedGloss> gloss_;
    std::optional<GlossyTransfer> lobe_;
};

/// With the viewer where none was named.
RecordedGloss glossOf(const GlossPlan& plan, const AnimatedMesh& animation, int first, int end) {
    RecordedGloss out{plan.exponent, plan.specular, plan.eye.value_or(Vec3(0))};
    if (plan.eye) return out;
    SceneBounds bounds;
    for (int f = first; f < end; ++f) {
        const std::vector<glm::vec3>& frame = animation.frames[static_cast<std::size_t>(f)];
        if (!allFinite(frame)) continue;
        for (const glm::vec3& p : frame) bounds.add(p);
    }
    out.eye = cameraSeeing(bounds).eye;
    return out;
}

/// Reads the plan's sets, or makes and writes them. \param frames  that will be computed
VisibleSets visibleSets(const SelfTransfer& transfer, const TransferPlan& plan,
                        const std::vector<NumberedFrame>& frames, TransferRun::Sets& told) {
    const Stopwatch watch;
    std::error_code ignored;
    VisibleSets sets;
    if (std::filesystem::exists(plan.visibleSets, ignored)) {
        sets = readVisibleSets(plan.visibleSets);
        if (sets.key != transfer.key() || sets.groups != transfer.groupCount() || sets.places != transfer.placeCount())
            throw Error(fmt::format("{}: expected visible sets of this mesh with these levels of detail, found others",
                                    plan.visibleSets));
        for (const NumberedFrame& frame : frames)
            if (sets.at(frame.number).empty())
                throw Error(fmt::format("{}: expected a set for frame {}, found none", plan.visibleSets, frame.number));
    } else {
        sets = findVisibleSets(transfer, frames, plan.windowFrames);
        writeVisibleSets(sets, plan.visibleSets);
        told.made = true;
    }
    std::size_t bits = 0, set = 0;
    for (const VisibleSets::Window& w : sets.windows) {
        bits += std::size_t{sets.groups} * sets.places;
        for (const std::uint64_t word : w.bits) set += static_cast<std::size_t>(std::popcount(word));
    }
    told.windows = sets.windows.size();
    told.bytes = std::filesystem::file_size(plan.visibleSets);
    told.share = bits > 0 ? static_cast<double>(set) / static_cast<double>(bits) : 0;
    told.seconds = watch.seconds();
    return sets;
}

}  // namespace

TransferRun runTransfer(const AnimatedMesh& animation, const TransferPlan& plan, const std::string& name,
                        const Progress& progress) {
    const auto [first, end] = std::pair(plan.first, plan.end);
    TransferRun run;
    TransferRecording& out = run.recording;
    const auto frameAt = [&](int f) -> const std::vector<glm::vec3>& {
        return animation.frames[static_cast<std::size_t>(f)];
    };
    const auto firstFinite = [&](int f) {
        while (f < end && !allFinite(frameAt(f))) ++f;
        return f;
    };
    if (firstFinite(first) == end)
        throw Error(fmt::format("{}: expected finite positions, found none in frames {} to {}", name, first, end - 1));
    const int rest = firstFinite(0);  // whichever frames are wanted: groups, levels and sets are the motion's
    const WeldedMesh mesh = weldMesh(animation, name);
    out.order = plan.options.order;
    out.framesPerSecond = animation.framesPerSecond;
    out.weldOf = mesh.weldOf;
    out.triangles = mesh.triangles;
    const std::vector<glm::vec3> restPositions = weldedPositions(mesh, frameAt(rest));
    for (std::size_t v = 0; v < mesh.weldOf.size(); ++v)
        run.joined += frameAt(rest)[v] != restPositions[mesh.weldOf[v]] ? 1 : 0;
    const auto poses = plan.poses ? motionPoses(mesh, animation) : std::vector<std::vector<glm::vec3>>();
    report(progress, "groups and levels of detail", 0);
    Method transfer(mesh, restPositions, plan, poses);
    if (plan.gloss) out.gloss = glossOf(*plan.gloss, animation, first, end);
    transfer.shine(out.gloss, plan.options);
    run.coarse = transfer.coarse();
    run.coarseTriangles = transfer.coarseTriangles();
    run.closed = mesh.closed;
    run.sides = transfer.sides();
    std::vector<NumberedFrame> frames;
    for (int f = first; f < end; ++f) {
        if (allFinite(frameAt(f)))
            frames.push_back({f, weldedPositions(mesh, frameAt(f))});
        else
            run.refused.push_back(f);
    }
    VisibleSets sets;
    if (!plan.visibleSets.empty()) {
        report(progress, "visible sets", 0);
        sets = visibleSets(transfer.self(), plan, frames, run.sets.emplace());
    }
    transfer.compute(restPositions);
    for (NumberedFrame& f : frames) {
        report(progress, "frames", static_cast<double>(f.number - first) / (end - first));
        if (!out.blocks.empty() && f.positions == out.blocks.back().positions) {
            ++run.reused;
        } else {
            const Stopwatch watch;
            TransferFrame frame = transfer.compute(f.positions, sets.at(f.number));
            add(run, frame, watch.seconds(), watch.cpuSeconds());
            out.blocks.push_back({std::move(f.positions), std::move(frame.coefficients)});
        }
        out.frames.push_back({f.number, static_cast<int>(out.blocks.size()) - 1});
    }
    run.bytes = transfer.bytes();
    if (run.computed > 0) {
        run.listed /= static_cast<double>(run.computed);
        run.drawn /= static_cast<double>(run.computed);
    }
    return run;
}

/// `count` of the frames, the first and the last among them.
static std::vector<TransferRecording::Frame> spread(const std::vector<TransferRecording::Frame>& all, int count) {
    const std::size_t most = std::min(static_cast<std::size_t>(count), all.size());
    std::vector<TransferRecording::Frame> out;
    for (std::size_t i = 0; i < most; ++i)
        out.push_back(all[most == 1 ? all.size() / 2 : i * (all.size() - 1) / (most - 1)]);
    return out;
}

static std::vector<glm::vec3> normalsOf(const TransferRecording& recording, const TransferRecording::Block& block) {
    return vertexNormals(recording.triangles, cornersOfVertices(recording.triangles, recording.vertexCount()),
                         block.positions);
}

std::vector<double> tracedVectors(const TransferRecording& recording, const TransferRecording::Block& block,
                                  std::size_t rays) {
    std::vector<std::uint32_t> all(recording.vertexCount());
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<glm::vec3> normals = normalsOf(recording, block);
    std::vector<double> out = tracedTransfer(recording.triangles, block.positions, normals, all, recording.order, rays);
    if (!recording.gloss) return out;
    const auto [exponent, specular, eye] = *recording.gloss;
    const std::vector<double> lobes = tracedGlossyTransfer(recording.triangles, block.positions, normals, eye,
                                                           phongLobe(exponent), recording.order, rays);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = (1 - specular) * out[i] + specular * lobes[i];
    return out;
}

TransferMeasure measureTransfer(const TransferRecording& recording, std::size_t rays, int frames,
                                const Progress& progress) {
    TransferMeasure out;
    const std::size_t count = recording.coefficientCount();
    std::vector<float> found;
    std::vector<double> truth;
    const std::vector<TransferRecording::Frame> chosen = spread(recording.frames, frames);
    for (const TransferRecording::Frame& frame : chosen) {
        report(progress, "tracing", static_cast<double>(out.frames.size()) / static_cast<double>(chosen.size()));
        out.frames.push_back(frame.number);
        const TransferRecording::Block& block = recording.blocks[static_cast<std::size_t>(frame.block)];
        const std::vector<glm::vec3> normals = normalsOf(recording, block);
        const std::vector<double> traced = tracedVectors(recording, block, rays);
        for (std::size_t v = 0; v < normals.size(); ++v) {
            if (normals[v] == glm::vec3(0)) continue;
            const auto from = static_cast<std::ptrdiff_t>(v * count), to = from + static_cast<std::ptrdiff_t>(count);
            truth.insert(truth.end(), traced.begin() + from, traced.begin() + to);
            found.insert(found.end(), block.coefficients.begin() + from, block.coefficients.begin() + to);
        }
    }
    out.error = transferError(found, truth, count);
    return out;
}

}  // namespace nacre::cli
