#include "demos/exhibit_builder.hpp"

#include <fmt/format.h>

#include "demos/picture.hpp"
#include "demos/stage.hpp"
#include "reference/image_compare.hpp"
#include "shading/primitives.hpp"
#include "shading/timing.hpp"

namespace nacre {
namespace {

/// Share of pixels that may lie beyond the end of the difference's colour scale.
constexpr double kBeyondScale = 0.001;

RenderTargetOptions targetOptions(int width, int height) {
    RenderTargetOptions options;
    options.width = kSupersample * width;
    options.height = kSupersample * height;
    return options;
}

Camera cameraFrom(double elevationDeg, double distance, double fovY) {
    Camera camera;
    camera.eye = distance * directionFromDeg(0, elevationDeg);
    camera.fovY = fovY;
    camera.near = distance - 2;
    camera.far = distance + 2;
    return camera;
}

}  // namespace

Body::Body(Mesh bodyMesh, const Camera& bodyCamera, int pictureSize)
    : mesh(std::move(bodyMesh)), gpu(mesh), camera(bodyCamera), size(pictureSize) {
    RaytraceOptions options;
    options.width = options.height = size;
    options.supersample = kSupersample;
    traced = traceSurface(mesh, camera, options);
}

Body sphereBody(int size) { return {makeSphere(1, 160, 80), cameraFrom(0, 5, 0.47), size}; }
Body nearSphereBody(int size) { return {makeSphere(1, 160, 80), cameraFrom(0, 3, 1.25), size}; }
Body torusBody(int size) { return {makeTorus(1, 0.45f, 160, 120), cameraFrom(38, 7, 0.42), size}; }

ExhibitBuilder::ExhibitBuilder(ProgramLoader& loader, std::string id, BuilderOptions options)
    : loader_(loader), id_(std::move(id)), options_(std::move(options)) {}

void ExhibitBuilder::row(const std::string& title, bool ours) { rows_.push_back({title, ours, {}}); }

void ExhibitBuilder::panel(const std::string& label, const Body& body, const EnvironmentSurface& surface,
                           const EnvironmentLookup& sky, const std::vector<Rgb>& truth) {
    panel(
        label, body,
        [this, &body, surface](const RenderTarget& target) {
            renderEnvironment(loader_, target, body.gpu, body.camera, surface);
        },
        sky, truth);
}

void ExhibitBuilder::panel(const std::string& label, const Body& body, std::function<void(const RenderTarget&)> draw,
                           const EnvironmentLookup& sky, const std::vector<Rgb>& truth) {
    report(options_.progress, id_ + ": " + label, 0);
    const RenderTarget target(targetOptions(body.size, body.size));
    target.clear();
    draw(target);
    if (sky.map) renderSky(loader_, target, body.camera, sky);
    RaytracedPicture picture = assemblePicture(body.traced, truth);
    rows_.back().panels.push_back({label, halved(target.read()), std::move(picture.radiance),
                                   std::move(picture.coverage), &body, std::move(draw)});
}

void ExhibitBuilder::panel(const std::string& label, std::function<void(const RenderTarget&)> draw,
                           const RaytracedPicture& truth) {
    report(options_.progress, id_ + ": " + label, 0);
    const RenderTarget target(targetOptions(truth.radiance.width(), truth.radiance.height()));
    target.clear();
    draw(target);
    rows_.back().panels.push_back(
        {label, halved(target.read()), truth.radiance, truth.coverage, nullptr, std::move(draw)});
}

void ExhibitBuilder::compared(const std::string& label, Image radiance, Image truth,
                              std::optional<double> milliseconds) {
    Image mask(truth.width(), truth.height(), 1);
    for (float& v : mask.data()) v = 1;
    rows_.back().panels.push_back(
        {label, std::move(radiance), std::move(truth), std::move(mask), nullptr, {}, milliseconds});
}

void ExhibitBuilder::picture(const std::string& label, Image radiance) {
    rows_.back().panels.push_back({label, std::move(radiance), {}, {}, nullptr, {}});
}

void ExhibitBuilder::forComparison() { rows_.back().panels.back().ours = false; }

double ExhibitBuilder::whiteOfTruths() const {
    double white = 0;
    for (const RawRow& row : rows_)
        for (const Raw& raw : row.panels)
            if (!raw.truth.empty()) white = std::max(white, pictureWhite(raw.truth, raw.mask));
    return white > 0 ? white : 1;
}

double ExhibitBuilder::scaleOfDifferences(double white) const {
    double scale = 1e-3;
    for (const RawRow& row : rows_)
        for (const Raw& raw : row.panels)
            if (!raw.truth.empty())
                scale = std::max(scale, differenceQuantile(raw.drawn, raw.truth, white, raw.mask, kBeyondScale));
    return roundUpScale(scale);
}

Panel ExhibitBuilder::encode(const Raw& raw, const std::string& stem, double white, double scale) const {
    Panel panel;
    panel.label = raw.label;
    panel.milliseconds = raw.milliseconds;
    panel.ours = raw.ours;
    panel.picture = encodePicture(stem + ".png", raw.drawn, white);
    if (raw.truth.empty()) return panel;
    const ImageDifference d = compareImages(raw.drawn, raw.truth, white, raw.mask);
    panel.comparison = Comparison{
        encodePicture(stem + "-reference.png", raw.truth, white),
        encodePicture(stem + "-difference.png", differenceImage(raw.drawn, raw.truth, white, scale, raw.mask), 1),
        d.psnrSrgb, d.relative};
    return panel;
}

void ExhibitBuilder::time(Exhibit& exhibit) const {
    std::vector<std::function<void()>> frames;
    std::vector<Panel*> panels;
    std::vector<std::unique_ptr<RenderTarget>> targets;
    const Body* first = nullptr;
    for (std::size_t r = 0; r < rows_.size(); ++r)
        for (std::size_t i = 0; i < rows_[r].panels.size(); ++i) {
            const Raw& raw = rows_[r].panels[i];
            if (!raw.draw) continue;
            if (first == nullptr) first = raw.body;
            targets.push_back(std::make_unique<RenderTarget>(targetOptions(raw.drawn.width(), raw.drawn.height())));
            frames.push_back([&raw, target = targets.back().get()] {
                target->clear();
                raw.draw(*target);
            });
            panels.push_back(&exhibit.rows[r].panels[i]);
        }
    if (frames.empty()) return;
    if (first != nullptr) {
        targets.push_back(std::make_unique<RenderTarget>(targetOptions(first->size, first->size)));
        frames.push_back([this, first, target = targets.back().get()] {
            target->clear();
            renderEnvironment(loader_, *target, first->gpu, first->camera, {});
        });
    }
    TimingOptions timing;
    timing.repeats = options_.timingRepeats;
    const std::vector<double> seconds = medianFrameSeconds(frames, timing);
    for (std::size_t i = 0; i < panels.size(); ++i) panels[i]->milliseconds = 1000 * seconds[i];
    if (first != nullptr) exhibit.geometryMilliseconds = 1000 * seconds.back();
}

void ExhibitBuilder::finish(Exhibit& exhibit, double white) {
    exhibit.id = id_;
    if (white <= 0) white = whiteOfTruths();
    const double scale = scaleOfDifferences(white);
    exhibit.differenceScale = scale;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        PanelRow row{rows_[r].title, {}, rows_[r].ours};
        for (std::size_t i = 0; i < rows_[r].panels.size(); ++i)
            row.panels.push_back(encode(rows_[r].panels[i], fmt::format("{}-{}-{}", id_, r + 1, i + 1), white, scale));
        exhibit.rows.push_back(std::move(row));
    }
    time(exhibit);
    exhibit.scene += fmt::format(" {} is shown as white.", formatNumber(white));
}

}  // namespace nacre
