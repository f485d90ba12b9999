#include "shading/transfer_player.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numeric>

#include "core/error.hpp"

namespace nacre {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Triangles whose vertices are welded already.
GpuVertexLight gpuOf(const std::vector<glm::uvec3>& triangles, std::size_t vertices) {
    std::vector<std::uint32_t> same(vertices);
    std::iota(same.begin(), same.end(), 0u);
    return {triangles, same};
}

void add(SceneBounds& bounds, const std::vector<glm::vec3>& positions) {
    for (const glm::vec3& p : positions)
        if (isFinite(Vec3(p))) bounds.add(p);
}

}  // namespace

LightCoefficients whiteLight(int order) {
    LightCoefficients out(static_cast<std::size_t>((order + 1) * (order + 1)), Rgb(0));
    out[0] = Rgb(std::sqrt(4 * kPi));
    return out;
}

LightCoefficients coefficientsOf(const PlayedLight& light, const HarmonicRotation& rotation) {
    const LightCoefficients blended = blendedLights(light.environments, light.weights);
    return light.turn == 0 ? blended : turnedLight(rotation, blended, {0, 1, 0}, light.turn);
}

Camera cameraAround(const SceneBounds& bounds, double azimuth, double elevation) {
    Camera camera = cameraSeeing(bounds);
    const double distance = glm::length(camera.eye - camera.target);
    camera.eye = camera.target + distance * Vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                                 std::cos(elevation) * std::cos(azimuth));
    camera.near = camera.far = 0;
    return withDepth(camera, bounds);
}

TransferPlayer::TransferPlayer(TransferRecording recording)
    : source_(std::move(recording)),
      rotation_(std::get<TransferRecording>(source_).order),
      gpu_(gpuOf(triangles(), vertexCount())) {
    for (const TransferRecording::Block& block : std::get<TransferRecording>(source_).blocks)
        add(bounds_, block.positions);
}

TransferPlayer::TransferPlayer(LiveTransfer live)
    : source_(std::move(live)),
      rotation_(std::get<LiveTransfer>(source_).transfer().options().order),
      gpu_(gpuOf(triangles(), vertexCount())) {
    for (const std::vector<glm::vec3>& frame : std::get<LiveTransfer>(source_).frames()) add(bounds_, frame);
}

std::size_t TransferPlayer::frameCount() const {
    return recording() ? recording()->frames.size() : std::get<LiveTransfer>(source_).frameCount();
}

int TransferPlayer::frameNumber(std::size_t frame) const {
    return recording() ? recording()->frames.at(frame).number : static_cast<int>(frame);
}

double TransferPlayer::framesPerSecond() const {
    return recording() ? recording()->framesPerSecond : std::get<LiveTransfer>(source_).framesPerSecond();
}

std::size_t TransferPlayer::frameAt(double time) const {
    const double count = static_cast<double>(frameCount()), frame = std::floor(time * framesPerSecond() + 1e-9);
    return static_cast<std::size_t>(std::min(frame - count * std::floor(frame / count), count - 1));
}

std::size_t TransferPlayer::vertexCount() const {
    return recording() ? recording()->vertexCount() : std::get<LiveTransfer>(source_).transfer().mesh().vertexCount();
}

const std::vector<glm::uvec3>& TransferPlayer::triangles() const {
    return recording() ? recording()->triangles : std::get<LiveTransfer>(source_).transfer().mesh().triangles;
}

Camera TransferPlayer::standardCamera() const {
    Camera camera = cameraSeeing(bounds_);
    if (!recording() || !recording()->gloss) return camera;
    camera.eye = recording()->gloss->eye;
    camera.near = camera.far = 0;
    return withDepth(camera, bounds_);
}

const std::vector<glm::vec3>& TransferPlayer::positions(std::size_t frame) const {
    require(frame < frameCount(), fmt::format("transfer: expected a frame below {}, found {}", frameCount(), frame));
    return recording() ? recording()->blocks[static_cast<std::size_t>(recording()->frames[frame].block)].positions
                       : std::get<LiveTransfer>(source_).frames()[frame];
}

void TransferPlayer::drawWith(std::span<const float> transfer, ProgramLoader& loader, const RenderTarget& target,
                              const Camera& camera, std::size_t frame, const PlayedLight& light, const Rgb& albedo) {
    const auto begin = Clock::now();
    const std::vector<glm::vec3> radiance = exitantRadiance(transfer, coefficientsOf(light, rotation_), albedo);
    cost_.lightSeconds = secondsSince(begin);
    gpu_.update(positions(frame), radiance);
    renderVertexLight(loader, target, gpu_, camera);
}

void TransferPlayer::draw(ProgramLoader& loader, const RenderTarget& target, const Camera& camera, std::size_t frame,
                          const PlayedLight& light, const Rgb& albedo) {
    cost_ = {};
    require(frame < frameCount(), fmt::format("transfer: expected a frame below {}, found {}", frameCount(), frame));
    if (recording()) {
        const auto block = static_cast<std::size_t>(recording()->frames[frame].block);
        return drawWith(recording()->blocks[block].coefficients, loader, target, camera, frame, light, albedo);
    }
    auto& live = std::get<LiveTransfer>(source_);
    const auto begin = Clock::now();
    live.show(frame, camera.eye);
    cost_.computed = live.computed();
    cost_.transferSeconds = secondsSince(begin);
    drawWith(live.coefficients(), loader, target, camera, frame, light, albedo);
}

}  // namespace nacre
