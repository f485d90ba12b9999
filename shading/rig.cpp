#include "shading/rig.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

constexpr double kWeightSum = 1e-2;  // eight-bit weights round by 4 · 0.5 / 255
constexpr std::size_t kMaxFrames = 100'000, kMaxPositions = std::size_t{1} << 27;

Vec3 mix(const Vec3& a, const Vec3& b, double s) { return a + s * (b - a); }
glm::dquat mix(const glm::dquat& a, const glm::dquat& b, double s) {
    return glm::slerp(glm::normalize(a), glm::normalize(b), s);
}
std::vector<double> mix(std::vector<double> a, const std::vector<double>& b, double s) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += s * (b[i] - a[i]);
    return a;
}

template <class T>
T valueAt(const RigKeys<T>& keys, double time) {
    const auto after = std::upper_bound(keys.times.begin(), keys.times.end(), time);
    const auto next = static_cast<std::size_t>(after - keys.times.begin());
    if (next == 0) return keys.values.front();
    const double begin = keys.times[next - 1];
    // At a key itself the next one has no say: it may not be finite.
    if (next == keys.times.size() || time == begin) return keys.values[next - 1];
    return mix(keys.values[next - 1], keys.values[next], (time - begin) / (keys.times[next] - begin));
}

Mat4 localAt(const RigTrack& track, double time) {
    Mat4 out = glm::mat4_cast(glm::normalize(valueAt(track.rotation, time)));
    const Vec3 scale = valueAt(track.scale, time);
    for (int c = 0; c < 3; ++c) out[c] *= scale[c];
    out[3] = Vec4(valueAt(track.translation, time), 1);
    return out;
}

std::vector<Mat4> worldAt(const Rig& rig, const RigClip* clip, double time) {
    std::vector<Mat4> out;
    for (const RigNode& node : rig.nodes) out.push_back(node.local);
    if (clip)
        for (const RigTrack& track : clip->tracks) out[static_cast<std::size_t>(track.node)] = localAt(track, time);
    for (std::size_t i = 0; i < out.size(); ++i)
        if (rig.nodes[i].parent >= 0) out[i] = out[static_cast<std::size_t>(rig.nodes[i].parent)] * out[i];
    return out;
}

std::vector<Vec3> morphedAt(const RigPart& part, const RigClip* clip, double time) {
    std::vector<Vec3> out(part.positions.begin(), part.positions.end());
    if (part.targets.empty()) return out;
    std::vector<double> weights;
    for (const RigMorphTarget& target : part.targets) weights.push_back(target.weight);
    if (clip)
        for (const RigMorphTrack& track : clip->morphs)
            if (track.node == part.node) weights = valueAt(track.weights, time);
    for (std::size_t t = 0; t < part.targets.size(); ++t)
        for (std::size_t v = 0; weights[t] != 0 && v < out.size(); ++v)
            out[v] += weights[t] * Vec3(part.targets[t].positions[v] - part.positions[v]);
    return out;
}

/// Appends the part's vertices at that time.
void appendPart(std::vector<glm::vec3>& frame, const RigPart& part, const std::vector<Mat4>& world,
                const std::vector<Vec3>& positions) {
    std::vector<Mat4> bones;
    for (const RigBone& bone : part.bones)
        bones.push_back(world[static_cast<std::size_t>(bone.node)] * bone.inverseBind);
    std::vector<Vec4> sums(positions.size(), Vec4(0));  // w: the sum of weights
    for (const RigInfluence& i : part.influences)
        sums[i.vertex] += i.weight * Vec4(Vec3(bones[i.bone] * Vec4(positions[i.vertex], 1)), 1);
    const Mat4& own = world[static_cast<std::size_t>(part.node)];
    for (std::size_t v = 0; v < positions.size(); ++v)
        frame.push_back(sums[v].w > 0 ? Vec3(sums[v]) / sums[v].w : Vec3(own * Vec4(positions[v], 1)));
}

// ---- What must hold

template <class T>
void checkKeys(const RigKeys<T>& keys, const std::string& what) {
    if (keys.times.empty() || keys.times.size() != keys.values.size())
        throw Error(fmt::format("{}: expected a time for each key, found {} and {}", what, keys.times.size(),
                                keys.values.size()));
    for (std::size_t i = 0; i < keys.times.size(); ++i)
        if (!std::isfinite(keys.times[i]) || (i > 0 && keys.times[i] < keys.times[i - 1]))
            throw Error(fmt::format("{}: expected finite times in order, found {} as key {}", what, keys.times[i], i));
}

void checkClip(const Rig& rig, const RigClip& clip, const std::string& name) {
    const auto nodeName = [&](int node) {
        if (node < 0 || static_cast<std::size_t>(node) >= rig.nodes.size())
            throw Error(fmt::format("{}: expected a node below {}, found {}", name, rig.nodes.size(), node));
        return fmt::format("{}: clip \"{}\", node \"{}\"", name, clip.name,
                           rig.nodes[static_cast<std::size_t>(node)].name);
    };
    for (const RigTrack& track : clip.tracks) {
        const std::string what = nodeName(track.node);
        checkKeys(track.translation, what);
        checkKeys(track.rotation, what);
        checkKeys(track.scale, what);
    }
    for (const RigMorphTrack& track : clip.morphs) {
        const std::string what = nodeName(track.node);
        checkKeys(track.weights, what);
        for (const RigPart& part : rig.parts)
            for (const std::vector<double>& weights : track.weights.values)
                if (part.node == track.node && weights.size() != part.targets.size())
                    throw Error(fmt::format("{}: expected {} weights of morph targets, found {}", what,
                                            part.targets.size(), weights.size()));
    }
}

void checkPart(const RigPart& part, std::size_t nodes, const std::string& name,
               const std::function<void(const std::string&)>& note) {
    const auto isNode = [&](int node) { return node >= 0 && static_cast<std::size_t>(node) < nodes; };
    bool good = isNode(part.node);
    for (const RigBone& bone : part.bones) good = good && isNode(bone.node);
    if (!good) throw Error(fmt::format("{}: expected bones that are nodes, found others", name));
    const std::size_t vertices = part.positions.size();
    for (const glm::uvec3& t : part.triangles)
        if (std::max({t.x, t.y, t.z}) >= vertices)
            throw Error(fmt::format("{}: expected triangles of vertices below {}, found {}", name, vertices,
                                    std::max({t.x, t.y, t.z})));
    for (const RigMorphTarget& target : part.targets)
        if (target.positions.size() != vertices)
            throw Error(fmt::format("{}: expected a morph target of {} vertices, found {}", name, vertices,
                                    target.positions.size()));
    std::vector<double> sums(vertices);
    for (const RigInfluence& i : part.influences) {
        if (i.vertex >= vertices || i.bone >= part.bones.size() || !(i.weight >= 0) || !std::isfinite(i.weight))
            throw Error(
                fmt::format("{}: expected weights >= 0 of vertices below {} and bones below {}, found {} of {} "
                            "and {}",
                            name, vertices, part.bones.size(), i.weight, i.vertex, i.bone));
        sums[i.vertex] += i.weight;
    }
    if (part.bones.empty() || !note) return;
    const auto free = std::count(sums.begin(), sums.end(), 0.0);
    const auto off =
        std::count_if(sums.begin(), sums.end(), [](double sum) { return sum != 0 && std::abs(sum - 1) > kWeightSum; });
    if (free > 0) note(fmt::format("{}: {} vertices of a skin have no bone: they follow its node", name, free));
    if (off > 0)
        note(fmt::format("{}: the bone weights of {} vertices don't sum to 1: divided by their sum", name, off));
}

std::size_t frameCount(const RigClip* clip, double framesPerSecond, std::size_t vertices, const std::string& name) {
    if (!clip) return 1;
    const double frames = std::floor(clip->seconds * framesPerSecond + 1e-6) + 1;  // 1e-6: 2 s · 30/s are 61
    if (!(frames >= 1 && frames <= kMaxFrames))
        throw Error(
            fmt::format("{}: clip \"{}\": expected 1 to {} frames, found {}", name, clip->name, kMaxFrames, frames));
    const auto count = static_cast<std::size_t>(frames);
    if (count * vertices > kMaxPositions)
        throw Error(fmt::format("{}: clip \"{}\": expected at most {} positions, found {} frames of {}", name,
                                clip->name, kMaxPositions, count, vertices));
    return count;
}

}  // namespace

AnimatedMesh animateRig(const Rig& rig, const RigClip* clip, double framesPerSecond, const std::string& name,
                        const std::function<void(const std::string&)>& note) {
    AnimatedMesh out;
    std::size_t vertices = 0;
    bool hasUvs = false;
    for (std::size_t i = 0; i < rig.nodes.size(); ++i)
        if (rig.nodes[i].parent >= static_cast<int>(i))
            throw Error(fmt::format("{}: expected parents before their children, found node {} below {}", name, i,
                                    rig.nodes[i].parent));
    for (const RigPart& part : rig.parts) {
        checkPart(part, rig.nodes.size(), name, note);
        hasUvs = hasUvs || !part.uvs.empty();
    }
    if (clip) checkClip(rig, *clip, name);
    for (const RigPart& part : rig.parts) {
        for (const glm::uvec3& t : part.triangles) out.triangles.push_back(t + static_cast<std::uint32_t>(vertices));
        vertices += part.positions.size();
        if (!hasUvs) continue;
        out.uvs.insert(out.uvs.end(), part.uvs.begin(), part.uvs.end());
        out.uvs.resize(vertices);
    }
    if (out.triangles.empty()) throw Error(name + ": expected triangles, found none");
    out.framesPerSecond = framesPerSecond > 0                 ? framesPerSecond
                          : clip && clip->framesPerSecond > 0 ? clip->framesPerSecond
                                                              : 30;
    out.frames.resize(frameCount(clip, out.framesPerSecond, vertices, name));
    parallelFor(out.frames.size(), 0, [&](std::size_t f) {
        const double time = static_cast<double>(f) / out.framesPerSecond;
        const std::vector<Mat4> world = worldAt(rig, clip, time);
        for (const RigPart& part : rig.parts) appendPart(out.frames[f], part, world, morphedAt(part, clip, time));
    });
    checkAnimation(out, name);
    return out;
}

}  // namespace nacre
