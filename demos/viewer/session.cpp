#include "demos/viewer/session.hpp"

#include <epoxy/gl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "core/asset.hpp"
#include "core/error.hpp"
#include "demos/viewer/scene_edits.hpp"
#include "shading/image_output.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_programs.hpp"

namespace nacre {

namespace fs = std::filesystem;

ViewerSession::ViewerSession(SessionOptions options) : options_(std::move(options)) {
    loader_ = std::make_unique<ProgramLoader>();
    renderer_ = std::make_unique<SceneRenderer>(*loader_, nacre::readScene(options_.file));
    bounds_ = boundsOf(scene());
    camera = scene().camera;
    playing = scene().duration > 0;
    switches.specular.lightDepth = usualLightDepth(scene());
    watchFiles();
}

SessionState ViewerSession::state() const { return {options_, scene(), camera, time, playing, switches, problems_}; }

void ViewerSession::restore(const SessionState& last) {
    renderer_->setScene(last.scene);
    options_ = last.options;
    camera = last.camera;
    time = last.time;
    playing = last.playing;
    switches = last.switches;
    problems_ = last.problems;
    bounds_ = boundsOf(scene());
    watchFiles();
    touch();
}

std::vector<fs::path> ViewerSession::assetFolders() const {
    const auto folderOf = [](const fs::path& file) { return fs::absolute(file).lexically_normal().parent_path(); };
    std::set<fs::path> out = {folderOf(options_.file)};
    for (const SceneAsset& asset : scene().assets) out.insert(folderOf(asset.file));
    for (const fs::path& folder : options_.assetFolders) out.insert(fs::absolute(folder).lexically_normal());
    return {out.begin(), out.end()};
}

void ViewerSession::move(const Camera& to) {
    camera = to;
    camera.near = camera.far = 0;
    camera = withDepth(camera, bounds_);
    touch();
}

void ViewerSession::resetCamera() {
    camera = scene().camera;
    touch();
}

void ViewerSession::advance(double seconds) {
    if (playing) seek(time + seconds);
}

void ViewerSession::seek(double to) {
    const double duration = scene().duration;
    if (!(duration > 0)) return;
    time = to - duration * std::floor(to / duration);
    touch();
}

void ViewerSession::resize(int width, int height) {
    if (width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    touch();
}

RenderTarget& ViewerSession::sizedTarget() {
    if (!target_ || target_->width() != width_ || target_->height() != height_)
        target_.emplace(RenderTargetOptions{.width = width_, .height = height_, .samples = options_.samples});
    return *target_;
}

/// Of the lights' shadows, where the switches ask for them.
void ViewerSession::findLevels(const RenderTarget& target) {
    SceneSwitches& on = renderer_->switches;
    if (on.shadowMethod != ShadowMethod::Levels || !on.shadows) return;
    if (hasSpecular(scene())) {  // levels aren't in what its mirrors show
        on.shadowMethod = ShadowMethod::Maps;
        return;
    }
    if (!levels_) levels_.emplace(*loader_, renderer_->scene());
    on.lightLevels =
        levels_->draw(target.width(), target.height(), camera, time, {SampledShadowMethod::Maps, on.lightPoints});
}

void ViewerSession::drawOnce() {
    if (width_ < 1 || height_ < 1) return;
    renderer_->switches = atQuality(switches, quality ? quality->level() : 0);
    renderer_->setTiming(timing);
    RenderTarget& target = sizedTarget();
    const auto begin = std::chrono::steady_clock::now();
    findLevels(target);
    renderer_->render(target, camera, time);
    glFinish();
    passes_ = renderer_->passes();
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++pictures_;
}

bool ViewerSession::draw() {
    const bool moves = drawn_ != revision_;
    if ((!moves && !refines()) || width_ < 1 || height_ < 1) return false;
    drawn_ = revision_;
    const bool first = pictures_ == 0;
    if (quality) quality->next(moves);
    const bool drawn = attempt("picture", [&] { drawOnce(); });
    if (quality && drawn && !first) quality->took(seconds_);  // the first one compiles
    return drawn;
}

Image ViewerSession::pictureOf(int width, int height, int n) {
    require(width >= 1 && height >= 1 && n >= 1, "pictureOf: sizes must be >= 1");
    const RenderTarget other({.width = n * width, .height = n * height});
    renderer_->switches = switches;
    renderer_->setTiming(false);
    findLevels(other);
    renderer_->render(other, camera, time);
    const Image fine = other.read();
    Image out(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Rgb sum(0);
            for (int k = 0; k < n * n; ++k) sum += fine.rgb(n * x + k % n, n * y + k / n);
            out.setRgb(x, y, sum / double(n * n));
        }
    return out;
}

bool ViewerSession::attempt(const std::string& about, const std::function<void()>& work) {
    try {
        work();
    } catch (const std::exception& error) {
        problems_[about] = error.what();
        return false;
    }
    problems_.erase(about);
    return true;
}

/// A scene whose shaders don't compile is no good one either: the first picture decides.
void ViewerSession::apply(SceneDescription next) {
    SceneDescription last = scene();
    levels_.reset();
    renderer_->setScene(std::move(next));
    ++materials_;
    touch();
    try {
        drawOnce();
    } catch (...) {
        levels_.reset();
        renderer_->setScene(std::move(last));
        throw;
    }
    bounds_ = boundsOf(scene());
    if (scene().duration <= 0) time = 0, playing = false;
}

bool ViewerSession::setLight(std::size_t light, const SceneLight& value) {
    touch();
    return attempt("light", [&] { renderer_->setLight(light, value); });
}

bool ViewerSession::setNodeMaterial(std::size_t node, int material) {
    return attempt("material", [&] {
        const int last = scene().nodes.at(node).material;
        renderer_->setNodeMaterial(node, material);
        touch();
        try {
            drawOnce();
        } catch (...) {
            renderer_->setNodeMaterial(node, last);
            throw;
        }
    });
}

bool ViewerSession::setNodeMaterial(std::size_t node, const std::string& text) {
    return attempt("material", [&] {
        SceneDescription next = scene();
        next.nodes.at(node).material = materialFor(next, text, next.nodes.at(node).material);
        apply(std::move(next));
    });
}

bool ViewerSession::setMaterial(std::size_t material, const SceneMaterial& value) {
    return attempt("material", [&] {
        const SceneMaterial last = scene().materials.at(material);
        renderer_->setMaterial(material, value);
        ++materials_;
        touch();
        try {
            drawOnce();
        } catch (...) {
            renderer_->setMaterial(material, last);
            throw;
        }
    });
}

bool ViewerSession::setRelief(std::size_t material, const fs::path& file) {
    return attempt("relief", [&] {
        SceneDescription next = scene();
        std::optional<SceneRelief>& relief = next.materials.at(material).relief;
        if (file.empty()) {
            relief.reset();
        } else {
            const AssetTraits traits = traitsOf(readAsset(file), file.string());
            if (!relief) relief.emplace();
            relief->asset = assetFor(next, file);
            relief->shadow = traits.ellipses   ? BumpShadow::Ellipse
                             : traits.horizons ? BumpShadow::Horizon
                                               : BumpShadow::None;
        }
        apply(std::move(next));
        watchFiles();
    });
}

bool ViewerSession::replaceAsset(std::size_t asset, const fs::path& file) {
    return attempt("asset", [&] {
        SceneDescription next = scene();
        next.assets.at(asset).file = file;
        next.assets.at(asset).bake.reset();
        next.assets.at(asset).source.clear();
        apply(std::move(next));
        watchFiles();
    });
}

bool ViewerSession::setNodeTranslation(std::size_t node, const Vec3& value) {
    touch();
    return attempt("object", [&] {
        renderer_->setNodeTranslation(node, value);
        bounds_ = boundsOf(scene());
    });
}

bool ViewerSession::setSky(const SceneSky& value) {
    touch();
    ++materials_;
    return attempt("sky", [&] { renderer_->setSky(value); });
}

bool ViewerSession::open(const fs::path& file) {
    return attempt("scene", [&] {
        SceneDescription next = nacre::readScene(file);
        const Camera its = next.camera;
        const Camera last = camera;
        camera = its;
        try {
            apply(std::move(next));
        } catch (...) {
            camera = last;
            throw;
        }
        options_.file = file;
        switches.specular.hidden.clear();  // of the last scene's faces
        switches.specular.lightDepth = usualLightDepth(scene());
        time = 0;
        playing = scene().duration > 0;
        watchFiles();
    });
}

fs::path writeScreenshot(const Image& image, const fs::path& folder, double white) {
    const std::string stem = fmt::format("nacre-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
    fs::path png = folder / (stem + ".png");
    for (int again = 2; fs::exists(png); ++again) png = folder / fmt::format("{}-{}.png", stem, again);
    writePng(image, png, {white});
    writeExr(image, fs::path(png).replace_extension(".exr"));
    return png;
}

}  // namespace nacre
