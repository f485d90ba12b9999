#include "core/animation.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace nacre {

static constexpr std::size_t kMaxFrames = 100'000;

void checkAnimation(const AnimatedMesh& animation, const std::string& name) {
    if (animation.frames.empty()) throw Error(fmt::format("{}: expected at least one frame, found none", name));
    const std::size_t vertices = animation.vertexCount();
    for (std::size_t f = 0; f < animation.frames.size(); ++f)
        if (animation.frames[f].size() != vertices)
            throw Error(fmt::format("{}: topology changes: expected {} vertices as in frame 0, found {} in frame {}",
                                    name, vertices, animation.frames[f].size(), f));
    for (std::size_t t = 0; t < animation.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c)
            if (animation.triangles[t][c] >= vertices)
                throw Error(fmt::format("{}: expected vertices below {}, found {} in triangle {}", name, vertices,
                                        animation.triangles[t][c], t));
    if (!animation.uvs.empty() && animation.uvs.size() != vertices)
        throw Error(fmt::format("{}: expected {} uv coordinates, found {}", name, vertices, animation.uvs.size()));
}

AnimatedMesh resampled(const AnimatedMesh& animation, double framesPerSecond, const std::string& name) {
    require(std::isfinite(framesPerSecond) && framesPerSecond > 0,
            "resampled: frames per second must be finite and > 0");
    checkAnimation(animation, name);
    const std::size_t last = animation.frames.size() - 1;
    const double rate = animation.framesPerSecond / framesPerSecond;               // frames of the old a new one
    const double count = std::floor(static_cast<double>(last) / rate + 1e-6) + 1;  // 1e-6: the end is a frame too
    if (!(count <= kMaxFrames))
        throw Error(fmt::format("{}: expected at most {} frames, found {}", name, kMaxFrames, count));
    AnimatedMesh out = animation;
    out.framesPerSecond = framesPerSecond;
    out.frames.assign(static_cast<std::size_t>(count), {});
    for (std::size_t f = 0; f < out.frames.size(); ++f) {
        const double at = std::min(static_cast<double>(f) * rate, static_cast<double>(last));
        const auto before = static_cast<std::size_t>(at + 1e-6);
        out.frames[f] = animation.frames[before];
        const auto share = static_cast<float>(at - static_cast<double>(before));
        if (share < 1e-6f) continue;  // a key itself: the next one has no say, it may not be finite
        for (std::size_t v = 0; v < out.frames[f].size(); ++v)
            out.frames[f][v] += share * (animation.frames[before + 1][v] - out.frames[f][v]);
    }
    return out;
}

AnimatedMesh rigidAnimation(const std::vector<MovingBody>& bodies, double framesPerSecond, const std::string& name) {
    AnimatedMesh out;
    out.framesPerSecond = framesPerSecond;
    bool hasUvs = false;
    for (const MovingBody& body : bodies) hasUvs = hasUvs || !body.uvs.empty();
    for (const MovingBody& body : bodies) {
        require(body.frames.size() == bodies[0].frames.size(),
                "rigidAnimation: bodies differ in their number of frames");
        const std::size_t first = out.vertexCount(), last = first + body.positions.size();
        for (const glm::uvec3& t : body.triangles) {
            require(std::max({t.x, t.y, t.z}) < body.positions.size(), "rigidAnimation: triangles beyond the vertices");
            out.triangles.push_back(t + static_cast<std::uint32_t>(first));
        }
        if (hasUvs) out.uvs.insert(out.uvs.end(), body.uvs.begin(), body.uvs.end());
        if (hasUvs) out.uvs.resize(last);
        out.frames.resize(body.frames.size());
        for (std::size_t f = 0; f < body.frames.size(); ++f) {
            require(glm::determinant(glm::dmat3(body.frames[f])) > 0 && isFinite(Vec3(body.frames[f][3])),
                    "rigidAnimation: a matrix mirrors or isn't finite");
            for (const glm::vec3& p : body.positions) out.frames[f].push_back(Vec3(body.frames[f] * Vec4(Vec3(p), 1)));
        }
    }
    checkAnimation(out, name);
    return out;
}

}  // namespace nacre
