#include "transfer/live_transfer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "transfer/front_facing.hpp"

namespace nacre {
namespace {

bool allFinite(const std::vector<glm::vec3>& positions) {
    return std::all_of(positions.begin(), positions.end(), [](const glm::vec3& p) { return isFinite(Vec3(p)); });
}

SelfTransfer transferOf(WeldedMesh mesh, const AnimatedMesh& animation,
                        const std::vector<std::vector<glm::vec3>>& frames, const std::string& name,
                        const SelfTransferOptions& options) {
    const std::vector<std::vector<glm::vec3>> poses = motionPoses(mesh, animation);
    const auto rest = std::find_if(frames.begin(), frames.end(), allFinite);
    if (rest == frames.end()) throw Error(fmt::format("{}: expected finite positions, found none in any frame", name));
    return {std::move(mesh), *rest, options, poses};
}

std::vector<std::vector<glm::vec3>> weldedFrames(const AnimatedMesh& animation, const WeldedMesh& mesh) {
    std::vector<std::vector<glm::vec3>> out;
    for (const std::vector<glm::vec3>& frame : animation.frames) out.push_back(weldedPositions(mesh, frame));
    return out;
}

}  // namespace

LiveTransfer::LiveTransfer(const AnimatedMesh& animation, const std::string& name, const SelfTransferOptions& options)
    : name_(name),
      framesPerSecond_(animation.framesPerSecond),
      frames_(weldedFrames(animation, weldMesh(animation, name))),
      transfer_(transferOf(weldMesh(animation, name), animation, frames_, name, options)) {}

void LiveTransfer::show(std::size_t frame, const std::optional<Vec3>& eye) {
    require(frame < frames_.size(),
            fmt::format("{}: expected a frame below {}, found {}", name_, frames_.size(), frame));
    const std::vector<glm::vec3>& now = frames_[frame];
    if (!allFinite(now))
        throw Error(fmt::format("{}: expected finite positions, found others in frame {}", name_, frame));
    const bool moved = now != positions_;
    std::vector<std::uint8_t> wanted =
        eye ? frontFacing(transfer_.mesh(), now, *eye) : std::vector<std::uint8_t>(now.size(), 1);
    if (moved) {
        positions_ = now;
        known_.assign(now.size(), 0);
    }
    for (std::size_t v = 0; v < wanted.size(); ++v) {
        wanted[v] = wanted[v] && !known_[v];
        known_[v] = known_[v] || wanted[v];
    }
    computed_ = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), 1));
    if (computed_ == 0 && !moved) return;
    std::vector<float> fresh = transfer_.compute(positions_, wanted).coefficients;
    if (moved) {
        coefficients_ = std::move(fresh);
        return;
    }
    const std::size_t count = fresh.size() / wanted.size();
    for (std::size_t v = 0; v < wanted.size(); ++v)
        if (wanted[v]) std::copy_n(&fresh[v * count], count, &coefficients_[v * count]);
}

}  // namespace nacre
