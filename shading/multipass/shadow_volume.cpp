#include "shading/multipass/shadow_volume.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "core/error.hpp"

namespace nacre {
namespace {

std::uint32_t nearPoint(std::uint32_t i) { return 2 * i; }
std::uint32_t farPoint(std::uint32_t i) { return 2 * i + 1; }

std::vector<Vec3> moved(const ShadowMesh& mesh, const glm::dmat4& toWorld) {
    std::vector<Vec3> out;
    for (const glm::vec3& p : mesh.positions) out.emplace_back(toWorld * Vec4(Vec3(p), 1));
    return out;
}

/// Solid angle of the body's surface seen from p over 4π, signed: 0 outside (van Oosterom & Strackee 1983).
double winding(const std::vector<Vec3>& points, const std::vector<glm::uvec3>& triangles, const Vec3& p) {
    double sum = 0;
    for (const glm::uvec3& t : triangles) {
        const Vec3 a = points[t.x] - p, b = points[t.y] - p, c = points[t.z] - p;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += std::atan2(glm::dot(a, glm::cross(b, c)),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (2 * kPi);
}

bool isOutside(const std::vector<Vec3>& points, const std::vector<glm::uvec3>& triangles, const Vec4& light) {
    if (light.w == 0) return true;
    Bounds box;
    for (const Vec3& p : points) box.add(p);
    const Vec3 at(light);
    if (glm::any(glm::lessThan(at, box.low)) || glm::any(glm::greaterThan(at, box.high))) return true;
    return std::abs(winding(points, triangles, at)) < 1e-3;  // a light in the surface is taken for inside: always right
}

/// Whether a light lies in a triangle's plane as far as the mesh's floats tell: it lights no side of it then, while
/// either side's shadow would be half of space.
bool isInPlane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec4& light, double height, double normal) {
    constexpr double kRounding = 1e-6;
    const double size =
        light.w == 0 ? 1 : glm::length(Vec3(light) - a) + glm::length(b - a) + glm::length(c - a) + glm::length(a);
    return std::abs(height) <= kRounding * size * normal;
}

/// +1: the triangle counts as it is, seen counter-clockwise from the light; −1: turned over; 0: not at all.
std::vector<signed char> turns(const ShadowMesh& mesh, const glm::dmat4& toWorld, const Vec4& light, bool whole) {
    const std::vector<Vec3> points = moved(mesh, toWorld);
    const int outward = glm::determinant(glm::dmat3(toWorld)) < 0 ? -1 : 1;
    const bool half = whole && mesh.solid && isOutside(points, mesh.triangles, light);
    std::vector<signed char> out;
    for (const glm::uvec3& t : mesh.triangles) {
        const Vec3 &a = points[t.x], &b = points[t.y], &c = points[t.z], normal = glm::cross(b - a, c - a);
        const double facing = glm::dot(normal, Vec3(light) - light.w * a);
        const bool edgeOn = isInPlane(a, b, c, light, facing, glm::length(normal));
        const int turn = edgeOn ? 0 : facing > 0 ? 1 : -1;
        out.push_back(static_cast<signed char>(half && turn != outward ? 0 : turn));
    }
    return out;
}

/// The side that a triangle which goes from a to b, seen from the light, leaves there.
void addSide(std::vector<std::uint32_t>& out, std::uint32_t a, std::uint32_t b, bool toOnePoint) {
    out.insert(out.end(), {nearPoint(b), nearPoint(a), farPoint(a)});
    if (!toOnePoint) out.insert(out.end(), {nearPoint(b), farPoint(a), farPoint(b)});
}

void checkPlaced(const glm::dmat4& toWorld, const Vec4& light) {
    for (int i = 0; i < 4; ++i) require(isFinite(Vec3(toWorld[i])), "shadow volume: its matrix must be finite");
    require(isFinite(Vec3(light)), "shadow volume: the light's position must be finite");
}

void addSides(ShadowVolume& out, const ShadowMesh& mesh, const std::vector<signed char>& turn) {
    std::map<int, std::vector<std::uint32_t>> sides;  // by how often they count
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        int net = 0;
        for (const std::uint32_t use : mesh.usesOf(e)) net += (use & 1 ? -1 : 1) * turn[use / 2];
        if (net == 0) continue;
        const glm::uvec2 ends = net > 0 ? mesh.edges[e] : glm::uvec2(mesh.edges[e].y, mesh.edges[e].x);
        addSide(sides[std::abs(net)], ends.x, ends.y, !out.farCap);
    }
    for (const auto& [times, list] : sides) {
        out.sides.push_back(
            {static_cast<std::uint32_t>(out.indices.size()), static_cast<std::uint32_t>(list.size()), times});
        out.indices.insert(out.indices.end(), list.begin(), list.end());
    }
}

/// Takes a triangle after all that were taken before it.
void addCap(ShadowVolume::Caps& out, std::uint32_t triangle, int turn) {
    if (turn == 0) return;
    std::vector<ShadowVolume::Run>& runs = turn > 0 ? out.facing : out.turned;
    if (!runs.empty() && runs.back().first + runs.back().count == triangle)
        ++runs.back().count;
    else
        runs.push_back({triangle, 1});
}

}  // namespace

std::size_t ShadowVolume::Caps::triangles() const {
    std::size_t out = 0;
    for (const std::vector<Run>* runs : {&facing, &turned})
        for (const Run& run : *runs) out += run.count;
    return out;
}

std::size_t ShadowVolume::bytes() const {
    std::size_t runs = 0;
    for (const Caps* c : {&caps, &farCaps}) runs += c->facing.size() + c->turned.size();
    return indices.size() * sizeof(std::uint32_t) + runs * sizeof(Run);
}

Vec4 homogeneous(const Light& light) { return {light.position, light.directional ? 0 : 1}; }

ShadowVolume makeShadowVolume(const ShadowMesh& mesh, const glm::dmat4& toWorld, const Vec4& light) {
    checkPlaced(toWorld, light);
    const std::vector<signed char> turn = turns(mesh, toWorld, light, true);
    ShadowVolume out;
    out.farCap = light.w != 0;
    addSides(out, mesh, turn);
    for (std::uint32_t t = 0; t < turn.size(); ++t) addCap(out.caps, t, turn[t]);
    return out;
}

ShadowVolume makeShadowVolume(const ShadowMesh& mesh, const CutShadowMesh& cut, const glm::dmat4& toWorld,
                              const Vec4& light) {
    checkPlaced(toWorld, light);
    const std::vector<signed char> turn = turns(mesh, toWorld, light, false);
    ShadowVolume out;
    out.farCap = light.w != 0;
    out.cut = true;
    std::vector<signed char> ofPieces;
    for (std::uint32_t i = 0; i < cut.from.size(); ++i) {
        const std::uint32_t t = cut.from[i];
        ofPieces.push_back(turn[t]);
        if (i == 0 || cut.from[i - 1] != t) addCap(out.caps, t, turn[t]);
        if (out.farCap) addCap(out.farCaps, i, turn[t]);
    }
    addSides(out, cut.pieces, ofPieces);
    return out;
}

std::size_t bytesOfVolumeAPolygon(const ShadowMesh& mesh, const Vec4& light) {
    const std::size_t side = light.w == 0 ? 3 : 6;
    return mesh.triangles.size() * 3 * side * sizeof(std::uint32_t);
}

bool windowIsLit(std::span<const Vec3> window, const Bounds& casters, const Vec4& light) {
    if (casters.empty()) return true;
    std::vector<Vec3> normals{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t i = 0; i < window.size(); ++i) {
        const Vec3& a = window[i];
        const Vec3 edge = window[(i + 1) % window.size()] - a;
        normals.push_back(glm::cross(edge, Vec3(light) - light.w * a));
        if (i == 0) normals.push_back(glm::cross(edge, window[window.size() - 1] - a));
    }
    for (const Vec3& normal : normals)
        for (const Vec3& n : {normal, -normal}) {
            const double length = glm::length(n);
            if (!(length > 0)) continue;
            const Vec3 u = n / length;
            const Vec3 farthest(u.x > 0 ? casters.high.x : casters.low.x, u.y > 0 ? casters.high.y : casters.low.y,
                                u.z > 0 ? casters.high.z : casters.low.z);
            double least = light.w == 0 ? 1e300 : glm::dot(u, Vec3(light));
            for (const Vec3& w : window) least = std::min(least, glm::dot(u, w));
            const double most = glm::dot(u, farthest);
            const double rounding = 1e-6 * (std::abs(most) + std::abs(least) + glm::length(casters.high - casters.low));
            const bool lightAhead = light.w != 0 || glm::dot(u, Vec3(light)) >= 0;
            if (lightAhead && least > most + rounding) return true;
        }
    return false;
}

std::vector<Vec3> nearWindow(const glm::dmat4& clipToWorld) {
    std::vector<Vec3> out;
    for (const auto& [x, y] : std::array<std::pair<double, double>, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}) {
        const Vec4 p = clipToWorld * Vec4(x, y, -1, 1);
        out.emplace_back(Vec3(p) / p.w);
    }
    return out;
}

}  // namespace nacre
