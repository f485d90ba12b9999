#include "demos/teapot.hpp"

#include <array>

#include "core/error.hpp"

namespace nacre {
namespace {

// Newell's control points in his frame (z up). The parts of revolution are given by their profile (radius, height),
// from the axis at the top over the outside to the axis at the bottom; a quarter turn is the Bézier curve (r, 0),
// (r, kQuarter r), (kQuarter r, r), (0, r). (He rounds one of these products, 0.448, to 0.45 on the lid's knob.)
using Profile = std::array<Vec2, 4>;
constexpr double kQuarter = 0.56;
const std::array<Profile, 6> kProfiles = {{
    {{{0, 3.15}, {0.8, 3.15}, {0, 2.85}, {0.2, 2.7}}},                 // knob
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},              // lid
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},  // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}}},                // upper body
    {{{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},                // lower body
    {{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0}, {0, 0}}},                 // bottom
}};

// Handle and spout are symmetric about the plane y = 0. A row of control points of one half is
// (inner.x, 0, inner.y), (inner.x, −width, inner.y), (outer.x, −width, outer.y), (outer.x, 0, outer.y).
struct Row {
    Vec2 inner, outer;
    double width;
};
using Tube = std::array<Row, 4>;
const std::array<Tube, 4> kTubes = {{
    {{{{-1.6, 2.025}, {-1.5, 2.25}, 0.3},
      {{-2.3, 2.025}, {-2.5, 2.25}, 0.3},
      {{-2.7, 2.025}, {-3, 2.25}, 0.3},
      {{-2.7, 1.8}, {-3, 1.8}, 0.3}}},  // upper handle
    {{{{-2.7, 1.8}, {-3, 1.8}, 0.3},
      {{-2.7, 1.575}, {-3, 1.35}, 0.3},
      {{-2.5, 1.125}, {-2.65, 0.9375}, 0.3},
      {{-2, 0.9}, {-1.9, 0.6}, 0.3}}},  // lower handle
    {{{{1.7, 1.425}, {1.7, 0.6}, 0.66},
      {{2.6, 1.425}, {3.1, 0.825}, 0.66},
      {{2.3, 2.1}, {2.4, 2.025}, 0.25},
      {{2.7, 2.4}, {3.3, 2.4}, 0.25}}},  // spout
    {{{{2.7, 2.4}, {3.3, 2.4}, 0.25},
      {{2.8, 2.475}, {3.525, 2.49375}, 0.25},
      {{2.9, 2.475}, {3.45, 2.5125}, 0.15},
      {{2.8, 2.4}, {3.2, 2.4}, 0.15}}},  // its tip
}};

struct CurvePoint {
    Vec3 value, derivative;
};

/// Cubic Bézier curve and its derivative at t in [0, 1].
CurvePoint bezier(const std::array<Vec3, 4>& p, double t) {
    const double s = 1 - t;
    return {s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3],
            3.0 * (s * s * (p[1] - p[0]) + 2 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]))};
}

struct SurfacePoint {
    Vec3 position, tangent, normal;  ///< normal up to sign and length
};

/// S(u, v) = (r(v) c(u), z(v)). ∂S/∂u = r c', ∂S/∂v = (r' c, z'): their product divided by r, (c', 0) × (r' c, z'),
/// stays the normal at the poles, where r = 0.
SurfacePoint revolved(const Profile& profile, int quarter, double u, double v) {
    const double turn = quarter * kPi / 2, x = std::round(std::cos(turn)), y = std::round(std::sin(turn));
    const Vec3 a{x, y, 0}, b{-y, x, 0};
    const CurvePoint c = bezier({a, a + kQuarter * b, kQuarter * a + b, b}, u);
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = {profile[i].x, 0, profile[i].y};
    const CurvePoint p = bezier(points, v);
    const Vec3 up{0, 0, 1};
    return {p.value.x * c.value + p.value.z * up, c.derivative,
            cross(c.derivative, p.derivative.x * c.value + p.derivative.z * up)};
}

/// One half of a tube: side −1 as Newell's control points, +1 mirrored in y = 0. u runs around, v along.
SurfacePoint tube(const Tube& rows, double side, double u, double v) {
    std::array<Vec3, 4> atU, dAtU;
    for (int i = 0; i < 4; ++i) {
        const Row& row = rows[i];
        const double y = side * row.width;
        const CurvePoint p = bezier({Vec3{row.inner.x, 0, row.inner.y}, Vec3{row.inner.x, y, row.inner.y},
                                     Vec3{row.outer.x, y, row.outer.y}, Vec3{row.outer.x, 0, row.outer.y}},
                                    u);
        atU[i] = p.value;
        dAtU[i] = p.derivative;
    }
    const CurvePoint along = bezier(atU, v);
    const Vec3 dU = bezier(dAtU, v).value;
    // The mirror image turns the other way; −dU lets the tangent run on around the whole tube.
    return {along.value, -side * dU, cross(-side * dU, along.derivative)};
}

glm::vec3 yUp(const Vec3& p) { return glm::vec3(glm::dvec3(p.x, p.z, -p.y)); }

/// Adds a (segments + 1)² grid of surface(u, v); triangles without area, at the poles, are left out.
template <class Surface>
void addPatch(Mesh& mesh, int segments, const Vec2& uvOrigin, double outward, const Surface& surface) {
    const unsigned first = static_cast<unsigned>(mesh.positions.size()), row = static_cast<unsigned>(segments) + 1;
    for (int j = 0; j <= segments; ++j)
        for (int i = 0; i <= segments; ++i) {
            const Vec2 uv{static_cast<double>(i) / segments, static_cast<double>(j) / segments};
            const SurfacePoint p = surface(uv.x, uv.y);
            const Vec3 n = normalize(p.normal) * outward;
            const Vec3 t = normalize(p.tangent - n * dot(n, p.tangent));
            mesh.positions.push_back(yUp(p.position));
            mesh.normals.push_back(yUp(n));
            mesh.tangents.push_back(glm::vec4(yUp(t), 1.0f));
            mesh.uvs.push_back(glm::vec2(uvOrigin + uv));
        }
    const auto add = [&](unsigned a, unsigned b, unsigned c) {
        const glm::vec3 face = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        if (dot(face, face) == 0.0f) return;
        const glm::vec3 n = mesh.normals[a] + mesh.normals[b] + mesh.normals[c];
        mesh.triangles.push_back(dot(face, n) > 0 ? glm::uvec3{a, b, c} : glm::uvec3{a, c, b});
    };
    for (unsigned j = 0; j + 1 < row; ++j)
        for (unsigned i = 0; i + 1 < row; ++i) {
            const unsigned a = first + j * row + i;
            add(a, a + 1, a + row);
            add(a + 1, a + row + 1, a + row);
        }
}

}  // namespace

Mesh makeTeapot(int segments) {
    require(segments >= 1, "makeTeapot: segments must be >= 1");
    Mesh mesh;
    for (std::size_t part = 0; part < kProfiles.size(); ++part)
        for (int quarter = 0; quarter < 4; ++quarter)
            addPatch(mesh, segments, {quarter, static_cast<double>(part)}, -1,
                     [&](double u, double v) { return revolved(kProfiles[part], quarter, u, v); });
    for (std::size_t part = 0; part < kTubes.size(); ++part)
        for (const double side : {-1.0, 1.0})
            addPatch(mesh, segments, {side < 0 ? 0 : 1, static_cast<double>(kProfiles.size() + part)}, 1,
                     [&](double u, double v) { return tube(kTubes[part], side, u, v); });
    return mesh;
}

}  // namespace nacre
