// Shadow maps beside rays: the picture, and which pixels each way of storing depth misjudges (HSE section 2.1).
#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "demos/exhibit_task.hpp"
#include "demos/picture.hpp"
#include "demos/shadow_verdict.hpp"
#include "demos/stage.hpp"
#include "factorize/models/models.hpp"
#include "reference/image_compare.hpp"
#include "reference/raytrace.hpp"
#include "shading/alpha_shadow.hpp"
#include "shading/mesh_file.hpp"
#include "shading/primitives.hpp"
#include "shading/shadow_map.hpp"
#include "shading/timing.hpp"

namespace nacre {
namespace {

constexpr double kRatio = 1000;  ///< far / near of the depth codes

/// A scan on a floor before a wall, under a spot light.
struct Study {
    Mesh mesh;
    Camera camera;
    Light light;
    std::string words;
};

Study openStudy(const Task& task) {
    Stage stage = scanStage("armadillo", task.options.meshFolder);
    if (!stage.note.empty()) task.notes.push_back(task.id + ": " + stage.note);
    Study out;
    out.words = fmt::format("{}, {} triangles", stage.note.empty() ? "The armadillo" : "Newell's teapot",
                            stage.mesh.triangles.size());
    const double azimuth = std::atan2(stage.camera.eye.x, stage.camera.eye.z);
    out.mesh = transformed(stage.mesh, glm::rotate(glm::dmat4(1), -azimuth, Vec3(0, 1, 0)));
    fitToBox(out.mesh, 2);
    const glm::dmat4 floor = glm::translate(glm::dmat4(1), Vec3(0, boundsOf(out.mesh).low.y, 0)) *
                             glm::rotate(glm::dmat4(1), -kPi / 2, Vec3(1, 0, 0)),
                     wall = glm::translate(glm::dmat4(1), Vec3(0, 0, -1.6));
    out.mesh =
        joined(joined(std::move(out.mesh), transformed(makeQuad(9, 24), floor)), transformed(makeQuad(9, 24), wall));
    out.camera.eye = {1.0, 1.0, 4.6};
    out.camera.target = {-0.15, -0.1, 0};
    out.camera.fovY = 0.62;
    const Vec3 at(2, 3.2, 2.6);
    out.light = {false, at, Rgb(40), SpotCone{glm::normalize(Vec3(-0.1, -0.3, 0) - at), 0.35, 0.55}};
    return out;
}

/// One way of storing depth.
struct Method {
    std::string name;
    Image mask;
    ShadowView view;
    std::string cost;
};

std::string megabytes(double bytes) { return formatNumber(bytes / 1e6) + " MB"; }

/// What a map with near = far / kRatio says when one ray a texel is rounded in that code; the same bias rule for all.
Method codeMethod(const Study& study, const ShadowTruth& truth, int size, const DepthCode& code) {
    SceneShadow options;
    options.size = size;
    const Bounds bounds = boundsOf(study.mesh);
    options.far = fitShadow(options, study.light, bounds).far;
    options.near = options.far / kRatio;
    ShadowView view = fitShadow(options, study.light, bounds);
    if (!code.hyperbolic) view.resolution += 0.5 * (view.far - view.near) / std::pow(2.0, code.bits);
    const std::vector<Image> layers = tracedShadowMap(study.mesh, view, code);
    return {fmt::format("{}, {} bits", code.hyperbolic ? "z-buffer" : "linear", code.bits),
            truth.mask(view, layers, code.hyperbolic ? code.bits : 0), view,
            megabytes(1.0 * size * size * code.bits / 8)};
}

/// All that is drawn on the GPU.
class Drawings {
public:
    Drawings(const Task& task, const Study& study, int pixels)
        : loader_(task.loader),
          study_(study),
          pixels_(pixels),
          size_(task.size(1024)),
          repeats_(3 * task.options.timingRepeats),
          mesh_(study.mesh),
          shiny_(directBrdf(makeModel(kModel)).value()),
          matt_(directBrdf(makeModel("lambert")).value()) {
        for (const int bits : {32, 16}) {
            SceneShadow options;
            options.size = size_, options.bits = bits;
            maps_.emplace_back(options).update(loader_, study.light, scene());
        }
        for (const int bits : {8, 16, 32}) {
            alphas_.emplace_back(AlphaShadowOptions{size_, bits}).update(loader_, study.light, scene());
            alphaBits_.push_back(bits);
        }
    }
    static constexpr const char* kModel = "blinn-phong:n=30,kd=0.6,ks=0.2";

    void draw(const RenderTarget& target, bool shadow) const {
        LitView view{study_.camera, {study_.light}};
        if (shadow) view.shadows = {&maps_[0]};
        renderDirect(loader_, target, mesh_, view, shiny_);
    }

    /// With what each costs, timed in turns.
    std::vector<Method> methods() const {
        const RenderTarget target({.width = pixels_, .height = pixels_});
        std::vector<Method> out;
        for (const ShadowMap& map : maps_) {
            target.clear();
            renderShadowMask(loader_, target, mesh_, study_.camera, map);
            out.push_back({fmt::format("fused, linear {} bits", map.options().bits), target.read(1), map.view(), {}});
        }
        for (std::size_t i = 0; i < alphas_.size(); ++i)
            out.push_back(
                {fmt::format("alpha test, {} bits", alphaBits_[i]), alphaMask(alphas_[i]), alphas_[i].view(), {}});
        addCosts(out, target);
        return out;
    }

private:
    ShadowScene scene() const { return {{{&mesh_}}, boundsOf(study_.mesh), &study_.camera, 1}; }

    /// Lit where a light so bright that all it reaches shows arrives.
    Image alphaMask(const AlphaShadow& shadow) const {
        const Image picture = alphaPicture(shadow, 1e5);
        Image out(pixels_, pixels_, 1);
        for (std::size_t i = 0; i < out.data().size(); ++i)
            out.data()[i] = picture.data()[i * static_cast<std::size_t>(picture.channels()) + 1] > 0 ? 1 : 0;
        return out;
    }
    Image alphaPicture(const AlphaShadow& shadow, double intensity) const {
        Light light = study_.light;
        light.color = Rgb(intensity);
        return shadow.render(loader_, scene().casters, {study_.camera, {light}}, matt_, pixels_, pixels_);
    }

    void addCosts(std::vector<Method>& methods, const RenderTarget& target) const {
        std::vector<ShadowMap> maps;
        for (const ShadowMap& map : maps_) maps.emplace_back(map.options());
        std::vector<AlphaShadow> alphas;
        for (const int bits : alphaBits_) alphas.emplace_back(AlphaShadowOptions{size_, bits});
        const LitView plain{study_.camera, {study_.light}};
        std::vector<std::function<void()>> frames{
            [&] { target.clear(), renderDirect(loader_, target, mesh_, plain, matt_); },
            [&] { target.clear(), renderDirect(loader_, target, mesh_, plain, matt_), target.read(); }};
        for (ShadowMap& map : maps) {
            frames.emplace_back([&] { map.update(loader_, study_.light, scene()); });
            frames.emplace_back([&] {
                LitView view = plain;
                view.shadows = {&map};
                target.clear(), renderDirect(loader_, target, mesh_, view, matt_);
            });
        }
        for (AlphaShadow& shadow : alphas) {
            frames.emplace_back([&] { shadow.update(loader_, study_.light, scene()); });
            frames.emplace_back([&] { alphaPicture(shadow, 10); });
        }
        const std::vector<double> s = medianFrameSeconds(frames, {.repeats = repeats_});
        for (std::size_t i = 0; i < methods.size(); ++i) {
            const bool fused = i < maps_.size();
            const double bytes =
                fused ? static_cast<double>(maps_[i].bytes()) : 4.0 * size_ * size_ * alphaBits_[i - maps_.size()] / 8;
            methods[i].cost = fmt::format("{}, map {} ms, frame × {:.2f}", megabytes(bytes),
                                          formatNumber(1000 * s[2 + 2 * i]), s[3 + 2 * i] / s[fused ? 0 : 1]);
        }
    }

    ProgramLoader& loader_;
    const Study& study_;
    int pixels_, size_, repeats_;
    GpuMesh mesh_;
    GpuDirectBrdf shiny_, matt_;
    std::vector<ShadowMap> maps_;
    std::vector<AlphaShadow> alphas_;
    std::vector<int> alphaBits_;
};

void show(const std::vector<Method>& methods, const ShadowTruth& truth, double white, ExhibitBuilder& builder,
          ExhibitTable& table) {
    for (const Method& m : methods) {
        const ShadowError error = truth.compare(m.mask, m.view);
        const auto share = [&](std::size_t count) { return fmt::format("{:.3f} %", 100 * error.share(count)); };
        builder.picture(fmt::format("{}: {} acne, {} leaks, {} at boundaries; {}", m.name, share(error.acne),
                                    share(error.leaks), share(error.boundary), m.cost),
                        verdictPicture(truth.picture(), truth.judge(m.mask, m.view), white));
        table.rows.push_back({m.name, share(error.acne), share(error.leaks), share(error.boundary), m.cost});
    }
}

}  // namespace

Exhibit shadowStudyExhibit(const Task& task) {
    const Study study = openStudy(task);
    const int pixels = task.size(400);
    report(task.options.progress, task.id + ": reference", 0);
    const RaytracedPicture picture =
        raytrace(study.mesh, study.camera, {study.light}, makeModel(Drawings::kModel).f,
                 {.width = pixels, .height = pixels, .supersample = kSupersample, .shadows = true});
    const ShadowTruth truth(study.mesh, study.camera, study.light, {pixels, pixels});
    const double white = pictureWhite(picture.radiance, picture.coverage);
    const Drawings drawings(task, study, pixels);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    builder.row("The picture beside rays");
    builder.panel(
        "shadow map", [&](const RenderTarget& target) { drawings.draw(target, true); }, picture);
    builder.row("The same without shadows: what they are good for, and what the rest of the frame costs", false);
    builder.panel(
        "no shadows", [&](const RenderTarget& target) { drawings.draw(target, false); }, picture);

    Exhibit e;
    e.table.head = {"depth", "acne", "leaks", "at boundaries", "cost"};
    report(task.options.progress, task.id + ": misjudged pixels", 0);
    const std::vector<Method> drawn = drawings.methods();
    builder.row("Misjudged by the map that the pass looks up, near and far fitted");
    show({drawn[0], drawn[1]}, truth, white, builder, e.table);
    std::vector<Method> linear, zBuffer;
    for (const int bits : {8, 16, 32}) linear.push_back(codeMethod(study, truth, task.size(1024), {false, bits}));
    for (const int bits : {8, 16, 24}) zBuffer.push_back(codeMethod(study, truth, task.size(1024), {true, bits}));
    builder.row("Misjudged with linear depth, near/far = 1/1000, one ray a texel", false);
    show(linear, truth, white, builder, e.table);
    builder.row("Misjudged with a z-buffer's depth, the same near and far", false);
    show(zBuffer, truth, white, builder, e.table);
    builder.row("Misjudged by the paper's alpha test, near and far fitted", false);
    show({drawn.begin() + 2, drawn.end()}, truth, white, builder, e.table);

    e.section = "Shadow maps";
    e.title = "What a shadow map gets wrong, and what it costs";
    e.caption = fmt::format(
        "Each visible point that faces the light is lit or not, as a ray to the light says; where a map decides "
        "otherwise the pixel is red (acne: lit, called shadowed), blue (a leak: shadowed, called lit) or yellow "
        "(either, but within the filter of a true shadow edge, which texels can't resolve). Shares are of those "
        "points. The map in use: {} acne, {} leaks; {}. A linear map knows every distance to the same step; a "
        "z-buffer's steps grow with the distance squared, and so must its bias. The alpha test has no filter, and no "
        "bias that knows slopes. A frame is a multiple of the unshadowed frame, all timed in turns; the alpha test's "
        "counts reading back, in both. Traced maps have no time; their bytes are those of the bits.",
        e.table.rows[0][1], e.table.rows[0][2], e.table.rows[0][4]);
    e.scene = fmt::format(
        "{}, on a floor before a wall; one spot light; maps of {} "
        "texels along an edge; filter of 3 texels; pictures of {} pixels along an edge.",
        study.words, task.size(1024), pixels);
    e.commands = {"nacre_bench --bars --techniques shadow"};
    builder.finish(e, white);
    return e;
}

}  // namespace nacre
