#include "shading/multipass/radiosity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/shadow_view.hpp"

namespace nacre {
namespace {

/// Where light arrives: a patch's middle or a vertex.
struct Receiver {
    Vec3 position, normal;
    Rgb irradiance{0};
};

struct Patch {
    std::array<Vec3, 3> corners;
    std::array<Vec3, 4> quarters;
    double area = 0;
    Rgb albedo{0}, unshot{0};  ///< unshot: radiosity
};

/// ∫ cosθ/π dω over a triangle, what of it is above the horizon: Lambert 1760, 1/2π Σ of each edge's angle times the
/// cosine between n and the edge's plane.
double triangleFactor(const std::array<Vec3, 3>& corners, const Vec3& at, const Vec3& n) {
    std::array<Vec3, 4> above;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = corners[i] - at, b = corners[(i + 1) % 3] - at;
        const double ha = glm::dot(a, n), hb = glm::dot(b, n);
        if (ha > 0) above[count++] = a;
        if ((ha > 0) != (hb > 0)) above[count++] = a + (b - a) * (ha / (ha - hb));
    }
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 &a = above[i], &b = above[(i + 1) % count], edge = glm::cross(a, b);
        const double sine = glm::length(edge);
        if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(edge, n) / sine;
    }
    return std::abs(sum) / (2 * kPi);
}

class Solver {
public:
    Solver(std::span<const RadiositySurface> surfaces, const Visible& visible) : visible_(visible) {
        for (const RadiositySurface& s : surfaces)
            for (const glm::vec3& p : s.mesh.positions) box_.add(Vec3(p));
        lift_ = 1e-4 * glm::length(box_.high - box_.low);
        for (const RadiositySurface& s : surfaces) addPatches(s);
        for (const RadiositySurface& s : surfaces) addVertices(s.mesh);
    }

    void lamps(std::span<const Light> lights) {
        for (Patch& p : patches_) {
            const Vec3 normal = receivers_[index(p)].normal;
            Rgb sum(0);
            for (const Vec3& q : p.quarters)
                for (const Light& light : lights) sum += lamp(light, q, normal) / 4.0;
            p.unshot = p.albedo * sum;
            first_ += power(p);
        }
    }

    /// The patch with the most to give. \return  its power
    double shoot() {
        std::size_t best = 0;
        for (std::size_t i = 1; i < patches_.size(); ++i)
            if (power(patches_[i]) > power(patches_[best])) best = i;
        const Patch from = patches_[best];
        patches_[best].unshot = Rgb(0);
        const Vec3 normal = receivers_[best].normal;
        for (std::size_t i = 0; i < receivers_.size(); ++i) {
            if (i == best) continue;
            const Rgb got = from.unshot * formFactor(from, normal, receivers_[i]);
            receivers_[i].irradiance += got;
            if (i < patches_.size()) patches_[i].unshot += patches_[i].albedo * got;
        }
        return power(from);
    }

    double leftShare() const {
        double sum = 0;
        for (const Patch& p : patches_) sum += power(p);
        return first_ > 0 ? sum / first_ : 0;
    }

    std::vector<std::vector<glm::vec3>> radiance(std::span<const RadiositySurface> surfaces) const {
        std::vector<std::vector<glm::vec3>> out;
        std::size_t at = patches_.size();
        for (const RadiositySurface& s : surfaces) {
            std::vector<glm::vec3>& list = out.emplace_back();
            for (std::size_t v = 0; v < s.mesh.positions.size(); ++v)
                list.emplace_back(s.albedo / kPi * receivers_[at++].irradiance);
        }
        return out;
    }

    bool empty() const { return patches_.empty(); }

private:
    std::size_t index(const Patch& p) const { return static_cast<std::size_t>(&p - patches_.data()); }
    static double power(const Patch& p) { return p.area * luminance(p.unshot); }

    void addPatches(const RadiositySurface& s) {
        for (const glm::uvec3& t : s.mesh.triangles) {
            const Vec3 a(s.mesh.positions[t.x]), b(s.mesh.positions[t.y]), c(s.mesh.positions[t.z]);
            const Vec3 cross = glm::cross(b - a, c - a), middle = (a + b + c) / 3.0;
            if (!(glm::length(cross) > 0)) continue;
            const Vec3 n = glm::normalize(cross), up = lift_ * n;
            const auto quarter = [&](const Vec3& corner) { return 0.5 * (corner + middle) + up; };
            patches_.push_back(
                {{a, b, c}, {middle + up, quarter(a), quarter(b), quarter(c)}, 0.5 * glm::length(cross), s.albedo, {}});
            receivers_.push_back({middle + up, n});
        }
    }

    /// A vertex in a corner lies in another surface: a little inwards it doesn't.
    void addVertices(const Mesh& mesh) {
        std::vector<Vec3> inner(mesh.positions.begin(), mesh.positions.end());
        for (const glm::uvec3& t : mesh.triangles)
            for (int k = 0; k < 3; ++k) {
                const Vec3 p(mesh.positions[t[k]]);
                const Vec3 rest = Vec3(mesh.positions[t[(k + 1) % 3]]) + Vec3(mesh.positions[t[(k + 2) % 3]]);
                inner[t[k]] = p + 0.03 * (rest - 2.0 * p);
            }
        for (std::size_t v = 0; v < inner.size(); ++v) {
            const Vec3 n(mesh.normals[v]);
            receivers_.push_back({inner[v] + lift_ * n, n});
        }
    }

    Rgb lamp(const Light& light, const Vec3& at, const Vec3& normal) const {
        const Vec3 to = light.directional ? light.position : glm::normalize(light.position - at);
        const double cosine = glm::dot(normal, to);
        if (cosine <= 0) return Rgb(0);
        const Vec3 end = light.directional ? at + 2.0 * glm::length(box_.high - box_.low) * to : light.position;
        return visible_(at, end) ? light.color * (lightFalloff(light, at) * cosine) : Rgb(0);
    }

    /// Share of what a receiver sees that is the patch: unoccluded, times the share of its quarters that are visible.
    double formFactor(const Patch& from, const Vec3& normal, const Receiver& to) const {
        int above = 0, seen = 0;
        for (const Vec3& q : from.quarters) {
            const Vec3 d = to.position - q;
            if (!(glm::dot(normal, d) > 0 && glm::dot(to.normal, d) < 0)) continue;
            ++above;
            seen += visible_(to.position, q);
        }
        return seen > 0 ? triangleFactor(from.corners, to.position, to.normal) * seen / above : 0;
    }

    const Visible& visible_;
    Bounds box_;
    double lift_ = 0, first_ = 0;
    std::vector<Patch> patches_;
    std::vector<Receiver> receivers_;  ///< a patch each, then the vertices, which give nothing on
};

}  // namespace

/// What is left falls about as an exponential of the shots.
static double shareDone(const IndirectLight& light, const RadiosityOptions& options) {
    const double byPower = light.left > 0 ? std::log(light.left) / std::log(options.left) : 1;
    return std::clamp(std::max(byPower, double(light.shots) / options.mostShots), 0.0, 1.0);
}

IndirectLight indirectLight(std::span<const RadiositySurface> surfaces, std::span<const Light> lights,
                            const Visible& visible, const RadiosityOptions& options) {
    for (const RadiositySurface& s : surfaces) {
        require(s.mesh.normals.size() == s.mesh.positions.size(), "radiosity: expected a normal for each position");
        for (int c = 0; c < 3; ++c) require(s.albedo[c] >= 0 && s.albedo[c] < 1, "radiosity: albedo must be in [0, 1)");
    }
    Solver solver(surfaces, visible);
    report(options.progress, "radiosity", 0);
    solver.lamps(lights);
    IndirectLight out;
    out.left = solver.leftShare();
    while (!solver.empty() && out.shots < options.mostShots && out.left > options.left) {
        if (!(solver.shoot() > 0)) break;
        out.left = solver.leftShare();
        ++out.shots;
        report(options.progress, "radiosity", shareDone(out, options));
    }
    out.radiance = solver.radiance(surfaces);
    return out;
}

IndirectLight sceneIndirectLight(const SceneDescription& scene, double time, std::span<const Rgb> albedos,
                                 const Visible& visible, const RadiosityOptions& options) {
    require(albedos.size() == scene.materials.size(), "radiosity: expected an albedo for each material");
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene, time);
    std::vector<RadiositySurface> surfaces(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (scene.nodes[i].mesh < 0) continue;
        surfaces[i] = {transformed(scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)].mesh, nodes[i]),
                       albedos[static_cast<std::size_t>(scene.nodes[i].material)]};
    }
    const std::vector<Light> lights = lightsInWorld(scene, nodes);
    const auto areas = areasInWorld(scene, nodes);
    std::vector<Light> points;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (areas[i])
            for (const Light& p : pointsOfArea(lights[i], *areas[i], 16)) points.push_back(p);
        else
            points.push_back(lights[i]);
    }
    return indirectLight(surfaces, points, visible, options);
}

}  // namespace nacre
