// What the viewer shows, without its window: a scene that is drawn, edited, and read again when its files change.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demos/viewer/file_watch.hpp"
#include "shading/hybrid/level_pass.hpp"
#include "shading/multipass/quality.hpp"
#include "shading/scene_bounds.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {

struct SessionOptions {
    std::filesystem::path file;                       ///< a scene, or a mesh
    std::vector<std::filesystem::path> assetFolders;  ///< offered beside the scene's own folder
    int samples = 1;                                  ///< per pixel
};

/// What a session shows, edits too, without the objects of its context.
struct SessionState {
    SessionOptions options;
    SceneDescription scene;
    Camera camera;
    double time = 0;
    bool playing = false;
    SceneSwitches switches;
    std::map<std::string, std::string> problems;
};

/// The context that is current in the constructor must be current in every call.
class ViewerSession {
public:
    /// \throws nacre::Error and std::invalid_argument: readScene, SceneRenderer
    explicit ViewerSession(SessionOptions options);
    /// For a new context after a lost one: to be asked for in the old one, or without any.
    SessionState state() const;
    /// Shows what another session showed.
    void restore(const SessionState& last);

    const SceneDescription& scene() const { return renderer_->scene(); }
    const SceneRenderer& renderer() const { return *renderer_; }
    ProgramLoader& loader() { return *loader_; }
    const SessionOptions& options() const { return options_; }
    std::vector<std::filesystem::path> assetFolders() const;

    // What the next picture shows. After a change call touch().
    Camera camera;
    double time = 0;  ///< of the animation [s]
    bool playing = false;
    SceneSwitches switches;
    bool timing = false;  ///< passes() are measured
    /// Moves among levels of quality, below the switches, to keep a time; none: always all.
    std::optional<QualityControl> quality{};
    bool refines() const { return quality && quality->refines() && drawn_ == revision_; }
    void touch() { ++revision_; }
    /// Grows with everything that changes the picture.
    int revision() const { return revision_; }

    /// Grows with everything that changes what assets and materials are.
    int materials() const { return materials_; }

    /// Takes `to`, with near and far fitted to the scene.
    void move(const Camera& to);
    void resetCamera();
    /// The animation goes on by `seconds` if it plays, and repeats.
    void advance(double seconds);
    void seek(double to);

    /// Size of the picture [pixels]; 0: nothing is drawn, the last picture stays.
    void resize(int width, int height);
    int width() const { return width_; }
    int height() const { return height_; }
    /// Draws if the picture isn't up to date. What can't be drawn is a problem, and the last picture stays.
    /// \return whether there is a new picture
    bool draw();
    /// The picture, once there is one.
    const RenderTarget* target() const { return target_ ? &*target_ : nullptr; }
    int pictures() const { return pictures_; }   ///< drawn so far
    double seconds() const { return seconds_; }  ///< that the last one took
    /// The same view in another size, drawn n × n times as large and averaged.
    Image pictureOf(int width, int height, int n);
    /// What the parts of the last picture took, with timing on.
    const std::vector<PassTime>& passes() const { return passes_; }

    // Edits. Each one that fails leaves everything as it was, and its reason among the problems.
    bool setLight(std::size_t light, const SceneLight& value);
    bool setNodeMaterial(std::size_t node, int material);
    /// Gives a node the material that a text stands for (materialFor).
    bool setNodeMaterial(std::size_t node, const std::string& text);
    bool setMaterial(std::size_t material, const SceneMaterial& value);
    /// Gives a material the relief of a bump asset, shadowed by what the file holds: ellipses, else horizons, else not.
    /// Scale and light of a relief that it has stay. An empty path takes the relief away.
    bool setRelief(std::size_t material, const std::filesystem::path& file);
    bool replaceAsset(std::size_t asset, const std::filesystem::path& file);
    bool setNodeTranslation(std::size_t node, const Vec3& value);
    bool setSky(const SceneSky& value);
    /// Another scene file.
    bool open(const std::filesystem::path& file);

    /// Looks at the files (time and size), and reads again what changed: baked assets, the scene and the files it
    /// names, shaders. \return whether anything happened
    bool poll();
    /// Reads scene and shaders again as if they had changed.
    void reload();

    /// What is wrong, by what it is about; the last good state is shown meanwhile.
    const std::map<std::string, std::string>& problems() const { return problems_; }
    void forget(const std::string& about) { problems_.erase(about); }

private:
    bool attempt(const std::string& about, const std::function<void()>& work);
    void apply(SceneDescription next);
    void drawOnce();
    void findLevels(const RenderTarget& target);
    void readScene();
    void readShaders();
    void watchFiles();
    RenderTarget& sizedTarget();

    SessionOptions options_;
    std::unique_ptr<ProgramLoader> loader_;
    std::unique_ptr<SceneRenderer> renderer_;  ///< after the loader that it uses
    std::optional<LevelPass> levels_;          ///< after the renderer whose scene it is of
    std::optional<RenderTarget> target_;
    SceneBounds bounds_;
    FileWatch sceneFiles_, shaderFiles_;
    std::map<std::string, std::string> problems_;
    int width_ = 0, height_ = 0, revision_ = 1, materials_ = 1, drawn_ = 0, pictures_ = 0;
    double seconds_ = 0;
    std::vector<PassTime> passes_;
};

/// Writes `image` as PNG and EXR into `folder`, named by the time: nacre-20260131-235959.png, with -2, … when taken.
/// \return the PNG's path. \throws nacre::Error naming the path
std::filesystem::path writeScreenshot(const Image& image, const std::filesystem::path& folder, double white);

}  // namespace nacre
