#include "shading/iqm_file.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr char kMagic[] = "INTERQUAKEMODEL";  // with its 0
constexpr std::size_t kHeader = 124, kArray = 20, kTriangle = 12, kJoint = 48, kPose = 88, kClip = 20;
constexpr std::size_t kMaxPoses = std::size_t{1} << 22;
constexpr std::size_t kMaxName = 255;
constexpr double kLowestRate = 1e-3, kHighestRate = 1e4;  // [frames/s]
constexpr std::size_t kChannels = 10;                     // translation, rotation (x y z w), scale

enum Kind { kPosition = 0, kTexture = 1, kBones = 4, kWeights = 5 };
enum Format { kByte = 1, kFloat = 7 };

/// The header's words by their place.
enum Word {
    kVersion = 0,
    kFileSize = 1,
    kTextCount = 3,
    kTextAt = 4,
    kArrayCount = 7,
    kVertexCount = 8,
    kArraysAt = 9,
    kTriangleCount = 10,
    kTrianglesAt = 11,
    kJointCount = 13,
    kJointsAt = 14,
    kPoseCount = 15,
    kPosesAt = 16,
    kClipCount = 17,
    kClipsAt = 18,
    kFrameCount = 19,
    kFrameChannels = 20,
    kFramesAt = 21
};

struct Pose {
    std::uint32_t mask = 0;
    std::array<double, kChannels> offset{}, scale{};
};

struct Transform {
    Vec3 translation;
    glm::dquat rotation;
    Vec3 scale;
};

Transform transformOf(const std::array<double, kChannels>& c) {
    Transform out{{c[0], c[1], c[2]}, {}, {c[7], c[8], c[9]}};
    out.rotation.x = c[3], out.rotation.y = c[4], out.rotation.z = c[5], out.rotation.w = c[6];
    return out;
}

Mat4 matrixOf(const Transform& t) {
    Mat4 out = glm::mat4_cast(glm::normalize(t.rotation));
    for (int c = 0; c < 3; ++c) out[c] *= t.scale[c];
    out[3] = Vec4(t.translation, 1);
    return out;
}

class IqmReader {
public:
    IqmReader(std::span<const std::uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    Rig read() {
        if (!isIqm(bytes_) || bytes_.size() < kHeader) throw Error(name_ + ": expected an IQM file, found another");
        if (header(kVersion) != 2)
            throw Error(fmt::format("{}: expected version 2, found {}", name_, header(kVersion)));
        if (header(kFileSize) != bytes_.size())
            throw Error(fmt::format("{}: expected {} bytes, found {}", name_, header(kFileSize), bytes_.size()));
        rig_.nodes.push_back({"", -1, Mat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1})});  // z up to y up
        readMesh();
        readJoints();
        readClips();
        return std::move(rig_);
    }

private:
    std::uint32_t word(std::size_t at) const {
        std::uint32_t out = 0;
        for (std::size_t i = 0; i < 4; ++i) out |= static_cast<std::uint32_t>(bytes_[at + i]) << (8 * i);
        return out;
    }
    float number(std::size_t at) const { return std::bit_cast<float>(word(at)); }
    std::size_t header(Word which) const { return word(16 + 4 * static_cast<std::size_t>(which)); }

    /// Where a part begins, once it is known to lie in the file. All sizes are 32-bit: products don't overflow.
    std::size_t placeOf(std::size_t at, std::size_t count, std::size_t size, const char* what) const {
        if (at > bytes_.size() || count * size > bytes_.size() - at)
            throw Error(fmt::format("{}: expected {} {} of {} bytes at {}, found the file's end at {}", name_, count,
                                    what, size, at, bytes_.size()));
        return at;
    }

    std::string textAt(std::size_t at) const {
        const std::size_t begin = placeOf(header(kTextAt), header(kTextCount), 1, "characters");
        std::string out;
        for (; at < header(kTextCount) && bytes_[begin + at] != 0 && out.size() < kMaxName; ++at)
            out += static_cast<char>(bytes_[begin + at]);
        return out;
    }

    void readMesh() {
        RigPart part;
        const std::size_t vertices = header(kVertexCount);
        const std::size_t arrays = placeOf(header(kArraysAt), header(kArrayCount), kArray, "vertex arrays");
        std::array<std::size_t, 6> at{}, format{};  // of each kind
        for (std::size_t i = 0; i < header(kArrayCount); ++i) {
            const std::size_t entry = arrays + i * kArray, kind = word(entry);
            if (kind != kPosition && kind != kTexture && kind != kBones && kind != kWeights) continue;
            const std::size_t components = word(entry + 12), expected = kind == kPosition  ? 3
                                                                        : kind == kTexture ? 2
                                                                                           : 4;
            format[kind] = word(entry + 8);
            const bool known = (format[kind] == kFloat && kind != kBones) || (format[kind] == kByte && kind >= kBones);
            if (components != expected || !known)
                throw Error(
                    fmt::format("{}: vertex array {}: expected {} components of 8 bits or float, found {} of "
                                "format {}",
                                name_, kind, expected, components, format[kind]));
            at[kind] = placeOf(word(entry + 16), vertices, components * (format[kind] == kFloat ? 4 : 1), "vertices");
        }
        if (vertices > 0 && format[kPosition] == 0) throw Error(name_ + ": expected positions, found none");
        for (std::size_t v = 0; v < vertices; ++v) {
            const std::size_t p = at[kPosition] + 12 * v, t = at[kTexture] + 8 * v;
            part.positions.push_back({number(p), number(p + 4), number(p + 8)});
            if (format[kTexture]) part.uvs.push_back({number(t), number(t + 4)});
            for (std::size_t i = 0; format[kBones] && format[kWeights] && i < 4; ++i) {
                const std::size_t w = at[kWeights] + (format[kWeights] == kFloat ? 4 : 1) * (4 * v + i);
                const double weight = format[kWeights] == kFloat ? number(w) : bytes_[w] / 255.0;
                if (weight != 0)
                    part.influences.push_back({static_cast<std::uint32_t>(v), bytes_[at[kBones] + 4 * v + i], weight});
            }
        }
        const std::size_t triangles = placeOf(header(kTrianglesAt), header(kTriangleCount), kTriangle, "triangles");
        for (std::size_t i = 0; i < header(kTriangleCount); ++i) {
            const std::size_t t = triangles + i * kTriangle;
            part.triangles.push_back({word(t), word(t + 8), word(t + 4)});
        }
        rig_.parts.push_back(std::move(part));
    }

    void readJoints() {
        const std::size_t joints = placeOf(header(kJointsAt), header(kJointCount), kJoint, "joints");
        std::vector<Mat4> bind = {Mat4(1)};  // of the nodes, in the file's coordinates
        for (std::size_t i = 0; i < header(kJointCount); ++i) {
            const std::size_t at = joints + i * kJoint;
            const auto parent = static_cast<std::int32_t>(word(at + 4));
            if (parent < -1 || parent >= static_cast<std::int64_t>(i))
                throw Error(fmt::format("{}: joint {}: expected a parent before it, found {}", name_, i, parent));
            std::array<double, kChannels> channels;
            for (std::size_t c = 0; c < kChannels; ++c) channels[c] = number(at + 8 + 4 * c);
            const Mat4 local = matrixOf(transformOf(channels));
            rig_.nodes.push_back({textAt(word(at)), parent + 1, local});
            bind.push_back(bind[static_cast<std::size_t>(parent + 1)] * local);
            rig_.parts[0].bones.push_back({static_cast<int>(i + 1), glm::inverse(bind.back())});
        }
        if (header(kJointCount) == 0) rig_.parts[0].influences.clear();
    }

    std::vector<Pose> readPoses() const {
        const std::size_t poses = placeOf(header(kPosesAt), header(kPoseCount), kPose, "poses");
        std::vector<Pose> out(header(kPoseCount));
        std::size_t channels = 0;
        for (std::size_t i = 0; i < out.size(); ++i) {
            const std::size_t at = poses + i * kPose;
            out[i].mask = word(at + 4);
            for (std::size_t c = 0; c < kChannels; ++c) {
                out[i].offset[c] = number(at + 8 + 4 * c);
                out[i].scale[c] = number(at + 8 + 4 * (kChannels + c));
                channels += out[i].mask >> c & 1;
            }
        }
        if (channels != header(kFrameChannels) || out.size() != header(kJointCount))
            throw Error(fmt::format("{}: expected poses of {} joints with {} channels, found {} with {}", name_,
                                    header(kJointCount), header(kFrameChannels), out.size(), channels));
        return out;
    }

    void readClips() {
        const std::size_t clips = placeOf(header(kClipsAt), header(kClipCount), kClip, "clips");
        if (header(kClipCount) == 0) return;
        const std::vector<Pose> poses = readPoses();
        const std::size_t stride = 2 * header(kFrameChannels);
        const std::size_t frames = placeOf(header(kFramesAt), header(kFrameCount), stride, "frames");
        std::size_t total = 0;
        for (std::size_t i = 0; i < header(kClipCount); ++i) {
            const std::size_t at = clips + i * kClip, first = word(at + 4), count = word(at + 8);
            const double rate = number(at + 12);
            if (count == 0 || first + count > header(kFrameCount) ||
                !(rate == 0 || (rate >= kLowestRate && rate <= kHighestRate)))
                throw Error(
                    fmt::format("{}: clip {}: expected frames below {} and a rate of 0 or {} to {}, found {} "
                                "from {} at {}",
                                name_, i, header(kFrameCount), kLowestRate, kHighestRate, count, first, rate));
            total += (count + 1) * (poses.size() + 1);
            if (total > kMaxPoses)
                throw Error(fmt::format("{}: expected at most {} poses, found more", name_, kMaxPoses));
            addClip(textAt(word(at)), rate, poses, frames + first * stride, count);
        }
    }

    /// The channels that a pose's mask names are one 16-bit number a frame: offset + number · scale; the others are the
    /// offset.
    void addClip(std::string clipName, double rate, const std::vector<Pose>& poses, std::size_t at, std::size_t count) {
        RigClip clip;
        clip.name = clipName.empty() ? std::to_string(rig_.clips.size()) : std::move(clipName);
        clip.framesPerSecond = rate;
        const double step = 1 / (rate > 0 ? rate : 30);
        clip.seconds = static_cast<double>(count - 1) * step;
        clip.tracks.resize(poses.size());
        for (std::size_t f = 0; f < count; ++f)
            for (std::size_t p = 0; p < poses.size(); ++p) {
                std::array<double, kChannels> channels = poses[p].offset;
                for (std::size_t c = 0; c < kChannels; ++c)
                    if (poses[p].mask >> c & 1) {
                        channels[c] += (bytes_[at] | bytes_[at + 1] << 8) * poses[p].scale[c];
                        at += 2;
                    }
                const Transform pose = transformOf(channels);
                RigTrack& track = clip.tracks[p];
                track.node = static_cast<int>(p + 1);
                const double time = static_cast<double>(f) * step;
                add(track.translation, time, pose.translation);
                add(track.rotation, time, pose.rotation);
                add(track.scale, time, pose.scale);
            }
        rig_.clips.push_back(std::move(clip));
    }

    template <class T>
    static void add(RigKeys<T>& keys, double time, const T& value) {
        keys.times.push_back(time);
        keys.values.push_back(value);
    }

    const std::span<const std::uint8_t> bytes_;
    const std::string& name_;
    Rig rig_;
};

}  // namespace

bool isIqm(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= sizeof kMagic && std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0;
}

Rig parseIqm(std::span<const std::uint8_t> bytes, const std::string& name) { return IqmReader(bytes, name).read(); }

}  // namespace nacre
