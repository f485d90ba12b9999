// What a session does when files change: the scene, its assets, the shaders.
#include <fmt/format.h>

#include <set>

#include "demos/viewer/session.hpp"
#include "shading/scene_file.hpp"

namespace nacre {

namespace fs = std::filesystem;

static bool sameCamera(const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up && a.orthographic == b.orthographic &&
           a.fovY == b.fovY && a.height == b.height && a.near == b.near && a.far == b.far;
}

void ViewerSession::watchFiles() {
    std::set<fs::path> own;  // assets are watched by the renderer; what they are baked from changes no picture
    for (const SceneAsset& asset : scene().assets) {
        own.insert(asset.file.lexically_normal());
        if (asset.bake)
            for (const std::string& input : asset.bake->inputs) own.insert(fs::path(input).lexically_normal());
    }
    std::vector<fs::path> files;
    for (const fs::path& file : filesNamedIn(options_.file))
        if (own.count(file.lexically_normal()) == 0) files.push_back(file);
    sceneFiles_.watch(files);
    std::vector<fs::path> shaders;
    for (const fs::path& folder : loader_->folders())
        for (fs::path& file : filesUnder(folder)) shaders.push_back(std::move(file));
    shaderFiles_.watch(shaders);
}

/// Keeps the view, unless the file's own camera is another one now.
void ViewerSession::readScene() {
    attempt("scene", [&] {
        SceneDescription next = nacre::readScene(options_.file);
        const Camera last = camera;
        if (!sameCamera(next.camera, scene().camera)) camera = next.camera;
        try {
            apply(std::move(next));
        } catch (...) {
            camera = last;
            throw;
        }
    });
    watchFiles();
}

/// A second renderer beside the first: passes keep programs, and the old ones must work until the new ones do.
void ViewerSession::readShaders() {
    attempt("shaders", [&] {
        auto loader = std::make_unique<ProgramLoader>(loader_->dialect(), loader_->folders());
        auto renderer = std::make_unique<SceneRenderer>(*loader, scene());
        renderer->switches = switches;
        const RenderTarget trial({.width = 8, .height = 8});
        renderer->render(trial, camera, time);
        loader->load("fullscreen.vert.glsl", "present.frag.glsl");
        levels_.reset();
        renderer_ = std::move(renderer);
        loader_ = std::move(loader);
        touch();
    });
    watchFiles();
}

bool ViewerSession::poll() {
    bool news = false;
    for (const AssetChange& change : renderer_->reloadAssets()) {
        news = true;
        const std::string about = fmt::format("asset '{}'", change.name);
        if (change.problem.empty())
            problems_.erase(about);
        else
            problems_[about] = change.problem;
        ++materials_;
        touch();
    }
    if (!sceneFiles_.changed().empty()) readScene(), news = true;
    if (!shaderFiles_.changed().empty()) readShaders(), news = true;
    return news;
}

void ViewerSession::reload() {
    readScene();
    readShaders();
    touch();
}

}  // namespace nacre
