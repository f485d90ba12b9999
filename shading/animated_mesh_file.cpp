#include "shading/animated_mesh_file.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/parallel.hpp"
#include "shading/assimp_rig.hpp"
#include "shading/hand_motion.hpp"
#include "shading/iqm_file.hpp"
#include "shading/md2_frames.hpp"

namespace nacre {

namespace fs = std::filesystem;
using Note = std::function<void(const std::string&)>;

namespace {

constexpr std::uint64_t kMaxBytes = 1ull << 30;

Rig readRig(const fs::path& path, std::span<const std::uint8_t> bytes, const Note& note) {
    if (isIqm(bytes)) return parseIqm(bytes, path.string());
    Rig rig = readAssimpRig(path, note);
    addCurl(rig);
    return rig;
}

/// \return its place in `clips`, which isn't empty
std::size_t clipNamed(const std::vector<AnimationClip>& clips, const std::string& wanted, const std::string& name) {
    if (wanted.empty()) return 0;
    std::string list;
    for (std::size_t i = 0; i < clips.size(); ++i) {
        if (clips[i].name == wanted) return i;
        list += fmt::format("{}{} ({:.3g} s)", i ? ", " : "", clips[i].name, clips[i].seconds);
    }
    for (std::size_t i = 0; i < clips.size(); ++i)
        if (std::to_string(i) == wanted) return i;
    throw Error(fmt::format("{}: expected a clip of {}, found \"{}\"", name, list, wanted));
}

void refuseClip(const std::string& wanted, const std::string& name) {
    if (!wanted.empty())
        throw Error(fmt::format("{}: expected no clip, for the file has none, found \"{}\"", name, wanted));
}

std::vector<AnimationClip> clipsOf(const std::vector<Md2Clip>& clips) {
    std::vector<AnimationClip> out;
    for (const Md2Clip& clip : clips) out.push_back({clip.name, static_cast<double>(clip.count - 1) / kMd2Rate});
    return out;
}

std::vector<AnimationClip> clipsOf(const Rig& rig) {
    std::vector<AnimationClip> out;
    for (const RigClip& clip : rig.clips) out.push_back({clip.name, clip.seconds});
    return out;
}

/// The key frames of a clip, read one after the other, and linearly between them.
AnimatedMesh loadMd2(const fs::path& path, std::span<const std::uint8_t> bytes, const AnimatedMeshOptions& options) {
    const std::string name = path.string();
    const std::vector<Md2Clip> clips = md2Clips(bytes, name);
    const Md2Clip& clip = clips[clipNamed(clipsOf(clips), options.clip, name)];
    AnimatedMesh keys;
    for (std::size_t f = 0; f < clip.count; ++f) {
        const Rig rig = readAssimpRig(path, options.note, static_cast<int>(clip.first + f));
        AnimatedMesh one = animateRig(rig, nullptr, kMd2Rate, name, options.note);
        if (f == 0) {
            keys = std::move(one);
        } else {
            if (one.triangles != keys.triangles) throw Error(name + ": expected the same triangles in all key frames");
            keys.frames.push_back(std::move(one.frames[0]));
        }
    }
    checkAnimation(keys, name);
    return resampled(keys, options.framesPerSecond > 0 ? options.framesPerSecond : kMd2Rate, name);
}

}  // namespace

std::vector<AnimationClip> animationClips(const fs::path& path) {
    const std::vector<std::uint8_t> bytes = readFile(path, kMaxBytes);
    return isMd2(bytes) ? clipsOf(md2Clips(bytes, path.string())) : clipsOf(readRig(path, bytes, {}));
}

AnimatedMesh loadAnimatedMesh(const fs::path& path, const AnimatedMeshOptions& options) {
    require(std::isfinite(options.framesPerSecond) && options.framesPerSecond >= 0,
            "loadAnimatedMesh: frames per second must be finite and >= 0");
    const std::string name = path.string();
    const std::vector<std::uint8_t> bytes = readFile(path, kMaxBytes);
    if (isMd2(bytes)) return loadMd2(path, bytes, options);
    const Rig rig = readRig(path, bytes, options.note);
    if (rig.clips.empty()) refuseClip(options.clip, name);
    const RigClip* clip = rig.clips.empty() ? nullptr : &rig.clips[clipNamed(clipsOf(rig), options.clip, name)];
    return animateRig(rig, clip, options.framesPerSecond, name, options.note);
}

}  // namespace nacre
