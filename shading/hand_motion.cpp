#include "shading/hand_motion.hpp"

#include <array>

namespace nacre {
namespace {

constexpr double kPeriod = 2;        // [s]
constexpr double kBend = -1.2;       // of a finger's joints when closed [rad]: −z towards −y
constexpr double kThumbBend = -0.5;  // its two joints
constexpr double kDelay = 0.05;      // from the little finger to the index finger, each [s]
constexpr int kKeys = 60;            // linear between them

using Chain = std::vector<std::string>;  // joints that bend, from the palm on; then the tip, which follows

std::vector<Chain> chains() {
    std::vector<Chain> out;
    for (const std::string finger : {"pinky", "ring", "middle", "index"}) {
        const std::string bone = finger + "-finger-phalanx-";
        out.push_back({bone + "proximal", bone + "intermediate", bone + "distal", finger + "-finger-tip"});
    }
    out.push_back({"thumb-phalanx-proximal", "thumb-phalanx-distal", "thumb-tip"});
    return out;
}

int nodeNamed(const Rig& rig, const std::string& name) {
    for (std::size_t i = 0; i < rig.nodes.size(); ++i)
        if (rig.nodes[i].name == name) return static_cast<int>(i);
    return -1;
}

std::vector<Mat4> bindPose(const Rig& rig) {
    std::vector<Mat4> out;
    for (const RigNode& node : rig.nodes)
        out.push_back(node.parent < 0 ? node.local : out[static_cast<std::size_t>(node.parent)] * node.local);
    return out;
}

void addKey(RigTrack& track, double time, const Mat4& local) {
    Vec3 scale;
    Mat3 turn(local);
    for (int c = 0; c < 3; ++c) {
        scale[c] = glm::length(turn[c]);
        turn[c] /= scale[c];
    }
    for (std::vector<double>* times : {&track.translation.times, &track.rotation.times, &track.scale.times})
        times->push_back(time);
    track.translation.values.push_back(Vec3(local[3]));
    track.rotation.values.push_back(glm::quat_cast(turn));
    track.scale.values.push_back(scale);
}

}  // namespace

bool addCurl(Rig& rig) {
    if (!rig.clips.empty()) return false;
    for (const Chain& chain : chains())
        for (const std::string& name : chain)
            if (nodeNamed(rig, name) < 0) return false;
    RigClip clip{kCurlClip, kPeriod, kKeys / kPeriod, {}, {}};
    const std::vector<Mat4> bind = bindPose(rig);
    std::vector<Chain> all = chains();
    for (std::size_t f = 0; f < all.size(); ++f) {
        const double bend = f + 1 == all.size() ? kThumbBend : kBend;
        const std::size_t first = clip.tracks.size();
        for (const std::string& name : all[f]) clip.tracks.push_back({nodeNamed(rig, name), {}, {}, {}});
        for (int k = 0; k <= kKeys; ++k) {
            const double time = kPeriod * k / kKeys,
                         phase = 2 * kPi * (time - kDelay * static_cast<double>(f)) / kPeriod;
            const double angle = bend * 0.5 * (1 - std::cos(phase));
            // The joints hang side by side, not one on the other: the bent finger's motion so far carries the next one.
            Mat4 motion(1);
            for (std::size_t j = 0; j < all[f].size(); ++j) {
                const auto node = static_cast<std::size_t>(clip.tracks[first + j].node);
                const int parent = rig.nodes[node].parent;
                const Mat4 above = parent < 0 ? Mat4(1) : bind[static_cast<std::size_t>(parent)];
                Mat4 world = motion * bind[node];
                if (j + 1 < all[f].size()) world *= glm::mat4_cast(glm::angleAxis(angle, Vec3(1, 0, 0)));
                motion = world * glm::inverse(bind[node]);
                addKey(clip.tracks[first + j], time, glm::inverse(above) * world);
            }
        }
    }
    rig.clips.push_back(std::move(clip));
    return true;
}

}  // namespace nacre
