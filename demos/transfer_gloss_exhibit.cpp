// HEMI's figures 1 and 4 with glossy surfaces: without shadows, matt, Phong's lobe, and a factored BRDF for the view.
#include <fmt/format.h>

#include "demos/recipe.hpp"
#include "demos/transfer_study.hpp"
#include "factorize/factorize.hpp"
#include "reference/analytic_brdf.hpp"
#include "reference/glossy_trace.hpp"
#include "shading/timing.hpp"
#include "transfer/exitant_radiance.hpp"
#include "transfer/front_facing.hpp"
#include "transfer/glossy_transfer.hpp"

namespace nacre {
namespace {

constexpr int kMask = 32, kOrder = 4;
constexpr std::size_t kCount = (kOrder + 1) * (kOrder + 1);
constexpr double kAlbedo = 0.8, kExponent = 20, kSpecular = 0.5;
constexpr const char* kMetal = "ggx:alpha=0.35,f0=0.95/0.64/0.54";

/// A colour of the factored BRDF as its shader computes it.
BrdfOfDirections channelOfBrdf(const FactoredBrdf& brdf, int channel) {
    return [&brdf, channel](const glm::vec3& wo, std::span<const glm::vec3> wi, std::span<float> f) {
        for (std::size_t i = 0; i < wi.size(); ++i) f[i] = static_cast<float>(evaluate(brdf, wi[i], wo)[channel]);
    };
}

/// What a surface reflects, by its lobes: one for all colours, or one each.
struct Shine {
    std::vector<const GlossyTransfer*> lobes;
    std::vector<IsotropicBrdf> truths;
    double diffuse = 0, specular = 1;  ///< factors
};

class GlossStudy {
public:
    GlossStudy(const Task& task, const ShownMotion& motion, TransferStudy& study, std::size_t rays)
        : loader_(task.loader),
          camera_(motion.camera),
          study_(study),
          rays_(rays),
          gpu_(motion.animation.triangles, study.transfer().mesh().weldOf) {}

    /// All that a frame costs, of the vertices that face the camera.
    TransferStudy::Draw found(std::size_t frame, const Shine& shine, const SphericalHarmonics& light) {
        return [this, frame, &shine, &light](const RenderTarget& target) {
            const std::vector<glm::vec3>& positions = study_.frames()[frame].positions;
            const GlossyFrame now = compute(frame, shine);
            gpu_.update(positions, radianceOf(now.diffuse.coefficients, now.lobes, shine, light));
            renderVertexLight(loader_, target, gpu_, camera_);
        };
    }

    /// The same by rays. Keeps the last ones it traced.
    TransferStudy::Draw traced(std::size_t frame, const Shine& shine, const SphericalHarmonics& light) {
        return [this, frame, &shine, &light](const RenderTarget& target) {
            const TransferStudyFrame& f = study_.frames()[frame];
            gpu_.update(f.positions, radianceOf(f.truth, truthOf(frame, shine), shine, light));
            renderVertexLight(loader_, target, gpu_, camera_);
        };
    }

    /// Of the lobes' transfer vectors that face the camera.
    TransferError error(std::size_t frame, const Shine& shine) const {
        const std::vector<std::vector<float>> traced = truthOf(frame, shine), now = compute(frame, shine).lobes;
        std::vector<float> found;
        std::vector<double> truth;
        for (std::size_t k = 0; k < traced.size(); ++k) {
            found.insert(found.end(), now[k].begin(), now[k].end());
            truth.insert(truth.end(), traced[k].begin(), traced[k].end());
        }
        return transferError(found, truth, kCount);
    }

    GlossyFrame compute(std::size_t frame, const Shine& shine) const {
        const std::vector<glm::vec3>& positions = study_.frames()[frame].positions;
        const SelfTransfer& transfer = study_.transfer();
        return computeLobes(transfer, positions, shine.lobes, camera_.eye,
                            frontFacing(transfer.mesh(), positions, camera_.eye));
    }

private:
    std::vector<std::vector<float>> truthOf(std::size_t frame, const Shine& shine) const {
        const TransferStudyFrame& f = study_.frames()[frame];
        std::vector<std::vector<float>> out;
        for (const IsotropicBrdf& brdf : shine.truths) {
            const std::vector<double> v = tracedGlossyTransfer(study_.transfer().mesh().triangles, f.positions,
                                                               f.normals, camera_.eye, brdf, kOrder, rays_);
            out.emplace_back(v.begin(), v.end());
        }
        return out;
    }

    static std::vector<glm::vec3> radianceOf(std::span<const float> diffuse,
                                             const std::vector<std::vector<float>>& lobes, const Shine& shine,
                                             const SphericalHarmonics& light) {
        std::vector<glm::vec3> out = exitantRadiance(diffuse, light.coefficients, Rgb(shine.diffuse));
        for (std::size_t k = 0; k < lobes.size(); ++k) {
            const std::vector<glm::vec3> lobe = exitantRadiance(lobes[k], light.coefficients, Rgb(shine.specular));
            for (std::size_t v = 0; v < out.size(); ++v)
                if (lobes.size() == 1)
                    out[v] += lobe[v];
                else
                    out[v][static_cast<int>(k)] += lobe[v][static_cast<int>(k)];
        }
        return out;
    }

    ProgramLoader& loader_;
    Camera camera_;
    TransferStudy& study_;
    std::size_t rays_;
    GpuVertexLight gpu_;
};

std::string percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

/// Means over the frames; the last cell, a time, still empty.
std::vector<std::string> errorRow(const std::string& surface, std::size_t frames,
                                  const std::function<TransferError(std::size_t)>& errorOf) {
    double median = 0, mean = 0, total = 0;
    for (std::size_t i = 0; i < frames; ++i) {
        const TransferError e = errorOf(i);
        median += e.median, mean += e.mean, total += e.total;
    }
    const auto count = static_cast<double>(frames);
    return {surface, percent(median / count), percent(mean / count), percent(total / count), ""};
}

}  // namespace

Exhibit transferGlossExhibit(const Task& task) {
    const TransferModel model{"mrfixit.iqm", "A skinned figure", {0.1, 0.35, 0.7}, 25, 12, 1.3};
    const std::size_t rays = task.options.quick ? 512 : 2048;
    report(task.options.progress, task.id + ": rays at the vertices", 0);
    const ShownMotion motion = openMotion(task, model);
    const TransferLight light = transferLight(task, "interior");
    TransferStudy study(task.loader, motion, rays);
    GlossStudy gloss(task, motion, study, rays);
    const GlossyTransfer phong(kMask, kOrder, MaskDetail::Bits, phongBrdf(static_cast<float>(kExponent)));
    const Reflectance metal = openReflectance(kMetal);
    const FactoredBrdf factored = factorize(metal, {});
    const BrdfFunction exact = *referenceBrdf(metal.source);
    std::vector<std::unique_ptr<GlossyTransfer>> colors;
    Shine lobe{{&phong}, {phongLobe(kExponent)}, kAlbedo * (1 - kSpecular), kAlbedo * kSpecular}, metallic;
    for (int c = 0; c < 3; ++c) {
        colors.push_back(std::make_unique<GlossyTransfer>(kMask, kOrder, MaskDetail::Bits, channelOfBrdf(factored, c)));
        metallic.lobes.push_back(colors.back().get());
        metallic.truths.emplace_back([&exact, c](const Vec3& wi, const Vec3& wo) { return exact(wi, wo)[c]; });
    }
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    const std::size_t frames = motion.frames.size();
    const auto row = [&](const std::string& title, bool ours, auto drawn, auto truth) {
        builder.row(title, ours);
        for (std::size_t i = 0; i < frames; ++i)
            builder.panel(fmt::format("frame {}", motion.frames[i]), drawn(i), pictureOf(truth(i), task.size(320)));
    };
    const SphericalHarmonics& l = light.coefficients;
    const auto byRays = [&](std::size_t i) { return study.rayTraced(i, l); };
    row(
        "Without shadows, matt", false, [&](std::size_t i) { return study.withoutShadows(i, l); }, byRays);
    row(
        "Matt", true, [&](std::size_t i) { return study.shadowed(i, l); }, byRays);
    ExhibitTable table{
        {"surface", "L2 error of its vectors, median", "mean", "of all", "ms a frame of the vertices that face"}, {}};
    std::vector<std::function<void()>> timed = {[&] {
        const std::vector<glm::vec3>& positions = study.frames()[0].positions;
        study.transfer().compute(positions, frontFacing(study.transfer().mesh(), positions, motion.camera.eye));
    }};
    table.rows.push_back(errorRow("matt", frames, [&](std::size_t i) { return study.frames()[i].error; }));
    for (const auto& [title, shine] :
         {std::pair(fmt::format("Half matt, half Phong's lobe of exponent {:g}", kExponent), &lobe),
          std::pair(fmt::format("A metal, {}, by its factored BRDF", kMetal), &metallic)}) {
        report(task.options.progress, task.id + ": rays of lobes", 0);
        row(
            title, true, [&](std::size_t i) { return gloss.found(i, *shine, l); },
            [&](std::size_t i) { return gloss.traced(i, *shine, l); });
        table.rows.push_back(errorRow(title, frames, [&](std::size_t i) { return gloss.error(i, *shine); }));
        timed.emplace_back([&gloss, s = shine] { gloss.compute(0, *s); });
    }
    const std::vector<double> seconds = medianFrameSeconds(timed, {.repeats = task.options.timingRepeats});
    for (std::size_t i = 0; i < seconds.size(); ++i) table.rows[i].back() = fmt::format("{:.2f}", 1e3 * seconds[i]);
    Exhibit e;
    e.section = "Self-shadows of moving meshes (HEMI)";
    e.title = "Glossy surfaces for the view (figures 1 and 4)";
    e.caption = fmt::format(
        "The masks of diffuse transfer serve any BRDF: for the viewer's direction the lobe times the cosine is "
        "integrated against the harmonics over the hidden bits and taken from the open hemisphere's, "
        "which a table by the viewer's elevation holds. The factored BRDF is evaluated as its shader does, a "
        "transfer vector a colour. References take {} rays a vertex and the unfactored model. Light of order 4 is all "
        "that both see: sharper reflections would need more harmonics. Views at a slant, where a metal is brightest, "
        "are "
        "what fills its error of all.",
        rays);
    e.scene = fmt::format("{}: {} vertices; {}; back faces black.", model.words, study.transfer().mesh().vertexCount(),
                          light.words);
    e.table = std::move(table);
    if (!motion.command.empty())
        e.commands = {fmt::format("nacre transfer {} -o frame.tv --frames {}:{} --glossy {:g} --reference {}",
                                  motion.command, motion.frames[0], motion.frames[0] + 1, kExponent, rays)};
    builder.finish(e);
    return e;
}

}  // namespace nacre
