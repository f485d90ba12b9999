#include "core/animation.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace nacre {

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

}  // namespace nacre
