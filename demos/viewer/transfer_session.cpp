#include "demos/viewer/transfer_session.hpp"

#include <epoxy/gl.h>

#include <cmath>

#include "envmaps/source.hpp"
#include "envmaps/spherical_harmonics.hpp"
#include "shading/motion.hpp"

namespace nacre {
namespace {

TransferPlayer playerOf(const TransferSessionOptions& options) {
    if (options.live) return TransferPlayer(LiveTransfer(loadMotion(options.file), options.file));
    return TransferPlayer(readTransfer(options.file));
}

PlayedLight lightOf(const std::vector<std::string>& files, int order) {
    if (files.empty()) return {{whiteLight(order)}, {1}};
    PlayedLight out;
    for (const std::string& file : files)
        out.environments.push_back(projectEnvironment(readEnvironment(file).map, order).coefficients);
    out.weights.assign(files.size(), 0);
    out.weights[0] = 1;
    return out;
}

}  // namespace

TransferSession::TransferSession(TransferSessionOptions options)
    : options_(std::move(options)), player_(playerOf(options_)) {
    light = lightOf(options_.environments, player_.order());
    playing = player_.frameCount() > 1;
    resetCamera();
}

void TransferSession::move(const Camera& to) {
    camera = to;
    camera.near = camera.far = 0;
    camera = withDepth(camera, player_.bounds());
}

void TransferSession::resetCamera() { camera = player_.standardCamera(); }

void TransferSession::turnLight(double by) {
    const double to = light.turn + by;
    light.turn = to - 2 * kPi * std::floor((to + kPi) / (2 * kPi));
}

void TransferSession::seek(double to) {
    const double duration = player_.duration();
    time = to - duration * std::floor(to / duration);
}

void TransferSession::step(int frames) {
    playing = false;
    seek((static_cast<double>(frame()) + frames + 0.5) / player_.framesPerSecond());
}

void TransferSession::advance(double seconds) {
    if (!playing) return;
    seek(time + seconds);
    if (turnSpeed != 0) turnLight(turnSpeed * seconds);
}

void TransferSession::resize(int width, int height) { width_ = width, height_ = height; }

void TransferSession::drawOnce() {
    if (!target_ || target_->width() != width_ || target_->height() != height_)
        target_.emplace(RenderTargetOptions{.width = width_, .height = height_, .samples = options_.samples});
    target_->clear();
    player_.draw(loader_, *target_, camera, frame(), light);
    glFinish();
    ++pictures_;
}

void TransferSession::noteSpeed() {
    const TransferPlayer::Cost& cost = player_.cost();
    if (cost.computed == 0) return;
    const double now = static_cast<double>(cost.computed) / cost.transferSeconds;
    verticesPerSecond_ = verticesPerSecond_ == 0 ? now : verticesPerSecond_ + 0.1 * (now - verticesPerSecond_);
}

bool TransferSession::draw() {
    const Shown now{frame(), light, camera.eye, camera.target, width_, height_};
    if (width_ < 1 || height_ < 1 || shown_ == now) return false;
    shown_ = now;
    try {
        drawOnce();
    } catch (const std::exception& error) {
        problem_ = error.what();
        return false;
    }
    problem_.clear();
    noteSpeed();
    return true;
}

}  // namespace nacre
