// What a depth map says of a point: the functions of core/shadow_view.hpp that shaders/nacre/shadow.glsl repeats.
#include <fmt/format.h>

#include "core/error.hpp"
#include "core/shadow_view.hpp"

namespace nacre {
namespace {

int cubeLayer(const Vec3& q) {
    const Vec3 a = glm::abs(q);
    if (a.x >= a.y && a.x >= a.z) return q.x > 0 ? 0 : 1;
    if (a.y >= a.z) return q.y > 0 ? 2 : 3;
    return q.z > 0 ? 4 : 5;
}

bool within(const Vec2& map, double edge) { return std::abs(map.x) <= edge && std::abs(map.y) <= edge; }

/// The first cascade that holds the point and its filter; else the last.
void placeInCascade(const ShadowView& view, ShadowPlace& place) {
    const double edge = 1 - static_cast<double>(view.filter) / view.size;
    const int count = view.layers();
    for (int i = 0; i < count && !place.inside; ++i) {
        const Vec3& c = view.cascades[static_cast<std::size_t>(i)];
        place.map = Vec2(place.q) * c.z + Vec2(c);
        place.layer = i;
        place.texel = 2 / (c.z * view.size);
        place.inside = within(place.map, edge);
    }
}

/// Direction of a map coordinate in a layer's light space: times the stored depth it is the stored point.
Vec3 tapDirection(const ShadowView& view, const Vec2& map) {
    const Vec2 p = map / view.scale;
    if (view.kind != ShadowKind::DualParaboloid) return {p, 1};
    const double s = glm::dot(p, p);
    return Vec3(2.0 * p, 1 - s) / (1 + s);
}

/// The surface point that a texel stores.
Vec3 storedPoint(const ShadowView& view, const ShadowPlace& place, const Vec2& map, double z) {
    if (view.kind != ShadowKind::Directional) return tapDirection(view, map) * z;
    const Vec3& c = view.cascades[static_cast<std::size_t>(place.layer)];
    return {(map - Vec2(c)) / c.z, z};
}

/// Weight of texel i of n along an edge: a box of n − 1 texels about the point, f in [0, 1) of a texel on.
double tapWeight(int i, int n, double f) { return n == 1 ? 1 : i == 0 ? 1 - f : i == n - 1 ? f : 1; }

}  // namespace

ShadowPlace shadowPlace(const ShadowView& view, const Vec3& position) {
    ShadowPlace place;
    place.q = Vec3(view.fromWorld * Vec4(position, 1));
    if (view.kind == ShadowKind::Directional) {
        placeInCascade(view, place);
        return place;
    }
    if (view.kind == ShadowKind::Cube) place.layer = cubeLayer(place.q);
    if (view.kind == ShadowKind::DualParaboloid) place.layer = place.q.z < 0 ? 1 : 0;
    place.q = shadowLayerFrame(view, place.layer) * place.q;
    if (view.kind == ShadowKind::DualParaboloid) {
        const double r = glm::length(place.q);
        const Vec2 p = Vec2(place.q) / (r + place.q.z);
        place.map = p * view.scale;
        place.texel = r * 4 / (view.scale * view.size * (1 + glm::dot(p, p)));
        place.inside = r > 0;
        return place;
    }
    if (!(place.q.z > 0)) return place;
    place.map = Vec2(place.q) / place.q.z * view.scale;
    place.texel = place.q.z * 2 / (view.scale * view.size);
    place.inside = within(place.map, 1 - static_cast<double>(view.filter) / view.size);
    return place;
}

double shadowBias(const ShadowView& view, double texel, double cosTheta) {
    if (view.bias) return *view.bias;
    const double h = view.filter * std::sqrt(0.5) * texel;
    return h * (1 - cosTheta * cosTheta / 2) + view.resolution;
}

double shadowLit(const ShadowView& view, std::span<const Image> layers, const Vec3& position, const Vec3& normal) {
    require(layers.size() == static_cast<std::size_t>(view.layers()),
            fmt::format("shadowLit: expected {} layers, found {}", view.layers(), layers.size()));
    const ShadowPlace place = shadowPlace(view, position);
    const bool parallel = view.kind == ShadowKind::Directional;
    const Vec3 m = -(shadowLayerFrame(view, place.layer) * (Mat3(view.fromWorld) * normal));
    const double facing = parallel ? m.z : glm::dot(m, place.q);
    if (facing <= 0) return 0;
    if (!place.inside) return 1;
    const double cosTheta = parallel ? facing : facing / glm::length(place.q);
    const double plane = glm::dot(m, place.q) - shadowBias(view, place.texel, cosTheta);
    const int n = view.filter;
    const Vec2 texels = (place.map * 0.5 + 0.5) * static_cast<double>(view.size) - (n % 2 == 0 ? 0.5 : 0.0);
    const Vec2 first = glm::floor(texels) - static_cast<double>((n - 1) / 2), f = texels - glm::floor(texels);
    const Image& layer = layers[static_cast<std::size_t>(place.layer)];
    double sum = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec2 at = first + Vec2(i, j);
            const auto texel = [&](double c) { return static_cast<int>(std::clamp(c, 0.0, view.size - 1.0)); };
            const double stored = layer.at(texel(at.x), texel(at.y), 0), d = stored >= 1 ? kShadowNothing : stored;
            const Vec2 map = (at + 0.5) * (2.0 / view.size) - 1.0;
            const Vec3 point = storedPoint(view, place, map, view.near + (view.far - view.near) * d);
            if (glm::dot(m, point) >= plane) sum += tapWeight(i, n, f.x) * tapWeight(j, n, f.y);
        }
    return n == 1 ? sum : sum / ((n - 1.0) * (n - 1.0));
}

}  // namespace nacre
