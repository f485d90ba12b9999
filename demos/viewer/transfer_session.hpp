// A moving mesh with its transfer as the viewer plays it, without its window.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "shading/transfer_player.hpp"

namespace nacre {

struct TransferSessionOptions {
    std::string file{};                       ///< what nacre transfer wrote; live: what loadMotion takes
    bool live = false;                        ///< transfer is computed for each frame shown
    std::vector<std::string> environments{};  ///< radiance maps; none: radiance 1 from everywhere
    int samples = 1;                          ///< per pixel
};

/// The context that is current in the constructor must be current in every call.
class TransferSession {
public:
    /// \throws nacre::Error as readTransfer, loadMotion, LiveTransfer and readEnvironment
    explicit TransferSession(TransferSessionOptions options);

    const TransferSessionOptions& options() const { return options_; }
    const TransferPlayer& player() const { return player_; }
    ProgramLoader& loader() { return loader_; }

    // What the next picture shows.
    Camera camera;
    double time = 0;  ///< of the animation [s]
    bool playing = false;
    PlayedLight light;
    double turnSpeed = 0;  ///< of the light while it plays [rad/s]
    std::size_t frame() const { return player_.frameAt(time); }

    void move(const Camera& to);  ///< with near and far fitted
    void resetCamera();
    void turnLight(double by);     ///< [rad], kept in [-π, π)
    void seek(double to);          ///< the animation repeats
    void step(int frames);         ///< from the frame shown, and stops playing
    void advance(double seconds);  ///< if it plays
    void resize(int width, int height);
    int width() const { return width_; }
    int height() const { return height_; }

    /// Draws when anything changed. What can't be drawn is the problem, and the last picture stays.
    bool draw();
    const RenderTarget* target() const { return target_ ? &*target_ : nullptr; }
    int pictures() const { return pictures_; }  ///< drawn so far
    const std::string& problem() const { return problem_; }
    /// Of the pictures for which any were, smoothed; 0 before the first.
    double verticesPerSecond() const { return verticesPerSecond_; }

private:
    void drawOnce();
    void noteSpeed();

    /// All that a picture depends on.
    struct Shown {
        std::size_t frame = 0;
        PlayedLight light;
        Vec3 eye{0}, target{0};
        int width = 0, height = 0;
        bool operator==(const Shown&) const = default;
    };

    TransferSessionOptions options_;
    ProgramLoader loader_;
    TransferPlayer player_;
    std::optional<RenderTarget> target_;
    std::optional<Shown> shown_;
    std::string problem_;
    int width_ = 0, height_ = 0, pictures_ = 0;
    double verticesPerSecond_ = 0;
};

}  // namespace nacre
