#include "shading/mean_light.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "shading/shading_frame.hpp"

namespace nacre {
namespace {

template <typename T>
T blend(const std::vector<T>& values, const glm::uvec3& t, const Vec3& w) {
    return static_cast<float>(w.x) * values[t.x] + static_cast<float>(w.y) * values[t.y] +
           static_cast<float>(w.z) * values[t.z];
}

}  // namespace

Vec3 meanLightDirection(const Mesh& mesh, const glm::dmat4& toWorld, const Light& light, int samples) {
    require(samples >= 1, "meanLightDirection: samples must be >= 1");
    const Mesh world = transformed(mesh, toWorld);
    std::vector<double> upTo;  // area of all triangles so far
    double area = 0;
    for (const glm::uvec3& t : world.triangles) {
        const Vec3 a(world.positions[t.x]), b(world.positions[t.y]), c(world.positions[t.z]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
        upTo.push_back(area);
    }
    Vec3 sum(0);
    if (!(area > 0)) return {0, 0, 1};
    for (int i = 0; i < samples; ++i) {
        const auto at = std::upper_bound(upTo.begin(), upTo.end(), (i + 0.5) / samples * area);
        const auto triangle = std::min(static_cast<std::size_t>(at - upTo.begin()), upTo.size() - 1);
        // Roberts' R2 sequence, folded into the triangle
        double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0), v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::uvec3& t = world.triangles[triangle];
        const Vec3 w(1 - u - v, u, v);
        const Mat3 frame = shadingFrame(Vec3(blend(world.normals, t, w)), Vec4(blend(world.tangents, t, w)));
        const Vec3 point(blend(world.positions, t, w));
        const Vec3 away = light.directional ? light.position : light.position - point;
        if (away == Vec3(0)) continue;
        const Vec3 local = glm::normalize(away) * frame;
        if (local.z > 0) sum += local * (local.z * lightFalloff(light, point));
    }
    return glm::length(sum) > 0 ? glm::normalize(sum) : Vec3(0, 0, 1);
}

}  // namespace nacre
