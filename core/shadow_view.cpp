#include "core/shadow_view.hpp"

#include <fmt/format.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr double kWidestSpot = 1.25;         ///< half angle [rad]: tan = 3, a ninth of the map's middle texels' share
constexpr double kLeastNear = 1e-5;          ///< of far: clips what touches a point light
constexpr double kRangeMargin = 1.0 / 1024;  ///< of the fitted depth range: the scene's ends aren't "nothing"

/// Texels that the filter needs beyond the map's content.
double guard(const SceneShadow& options) { return options.filter / 2 + 1; }

/// Rows x, y along the map and z away from the light. x × y = −z: seen from the light the map is not mirrored.
Mat3 axesAlong(const Vec3& forward) {
    const Vec3 up = std::abs(forward.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    const Vec3 right = glm::normalize(glm::cross(forward, up));
    return glm::transpose(Mat3(right, glm::cross(right, forward), forward));
}

glm::dmat4 rigid(const Mat3& axes, const Vec3& origin) {
    return glm::dmat4(axes) * glm::translate(glm::dmat4(1), -origin);
}

std::array<Vec3, 8> corners(const Bounds& b) {
    std::array<Vec3, 8> out;
    for (std::size_t i = 0; i < 8; ++i)
        out[i] = {(i & 1) ? b.high.x : b.low.x, (i & 2) ? b.high.y : b.low.y, (i & 4) ? b.high.z : b.low.z};
    return out;
}

Bounds moved(const Bounds& b, const glm::dmat4& m) {
    Bounds out;
    for (const Vec3& c : corners(b)) out.add(Vec3(m * Vec4(c, 1)));
    return out;
}

void check(const SceneShadow& o, const Light& light, const Bounds& scene, const Camera* camera) {
    require(o.size >= 8 && o.size <= 16384 && o.size % 2 == 0,
            fmt::format("shadow map: expected an even size of 8 to 16384, found {}", o.size));
    require(o.bits == 16 || o.bits == 32, fmt::format("shadow map: expected 16 or 32 bits, found {}", o.bits));
    require(o.filter >= 1 && o.filter <= 9, fmt::format("shadow map: expected a filter of 1 to 9, found {}", o.filter));
    require(o.cascades >= 1 && o.cascades <= 4,
            fmt::format("shadow map: expected 1 to 4 cascades, found {}", o.cascades));
    require(o.cascades == 1 || !light.directional || camera != nullptr, "shadow map: cascades need a camera");
    require(!o.bias || (std::isfinite(*o.bias) && *o.bias >= 0), "shadow map: bias must be finite, >= 0");
    require(
        std::isfinite(o.near) && std::isfinite(o.far) && o.near >= 0 && o.far >= 0 && (o.far == 0 || o.near < o.far),
        fmt::format("shadow map: expected 0 <= near < far, found {} and {}", o.near, o.far));
    require(!scene.empty() && isFinite(scene.low) && isFinite(scene.high), "shadow map: the scene's box is empty");
    require(isFinite(light.position), "shadow map: the light's position must be finite");
    require(!light.directional || std::abs(glm::length(light.position) - 1) < 1e-6,
            "shadow map: the direction to a directional light must have unit length");
    checkCone(light);
}

/// Depths of the box from the light, where options leave them open.
void fitRange(ShadowView& view, const SceneShadow& options, double low, double high) {
    const double margin = kRangeMargin * std::max(high - low, 1e-12);
    view.far = options.far > 0 ? options.far : high + margin;
    view.near = options.near > 0 ? options.near : low - margin;
}

/// near ≥ far / 1e5, for lights that have a place; a box wholly behind the light gets any range.
void fitPointRange(ShadowView& view, const SceneShadow& options, double low, double high) {
    fitRange(view, options, low, high > 0 ? high : 1);
    if (options.near == 0) view.near = std::max(view.near, kLeastNear * view.far);
    if (view.near >= view.far) view.near = kLeastNear * view.far;
}

/// Sphere about the part of the camera's pyramid between two depths: its size doesn't change as the camera turns.
Vec4 sliceSphere(const Camera& camera, double aspect, double near, double far) {
    const Vec3 forward = glm::normalize(camera.target - camera.eye);
    const double t = std::tan(camera.fovY / 2), k = t * t * (1 + aspect * aspect);
    if (camera.orthographic) {
        const double side = camera.height / 2 * std::sqrt(1 + aspect * aspect), half = (far - near) / 2;
        return {camera.eye + forward * ((near + far) / 2), std::hypot(side, half)};
    }
    // The centre on the axis that is equally far from near and far corners, at most at the far plane.
    const double at = std::min((near + far) / 2 * (1 + k), far);
    return {camera.eye + forward * at, std::sqrt(sqr(far - at) + k * far * far)};
}

Vec3 squareAbout(const Vec2& centre, double half, int size, double margin, bool snap) {
    const double s = (1 - 2 * margin / size) / half, texel = 2 / (s * size);
    const Vec2 c = snap ? glm::round(centre / texel) * texel : centre;
    return {-c * s, s};
}

void fitDirectional(ShadowView& view, const SceneShadow& options, const Light& light, const Bounds& scene,
                    const Camera* camera, double aspect) {
    const Bounds box = moved(scene, glm::dmat4(axesAlong(-light.position)));
    // The origin in the box's middle: light-space numbers stay small in single precision.
    const Vec3 centre = glm::inverse(axesAlong(-light.position)) * ((box.low + box.high) / 2.0);
    view.fromWorld = rigid(axesAlong(-light.position), centre);
    const Vec3 half = (box.high - box.low) / 2.0;
    fitRange(view, options, -half.z, half.z);
    const double least = 1e-9 * std::max(1.0, maxComponent(half));
    const double whole = std::max({half.x, half.y, least});
    if (options.cascades == 1) {
        view.cascades = {squareAbout({0, 0}, whole, options.size, guard(options), false)};
        return;
    }
    const Bounds seen = moved(scene, camera->view());
    const double near = std::max(camera->near, -seen.high.z),
                 far = std::max(std::min(camera->far, -seen.low.z), near * 1.001);
    const auto split = [&](int i) {
        const double share = static_cast<double>(i) / options.cascades;
        return 0.5 * (near + (far - near) * share) + 0.5 * near * std::pow(far / near, share);
    };
    for (int i = 0; i < options.cascades; ++i) {
        const Vec4 sphere = sliceSphere(*camera, aspect, split(i), split(i + 1));
        const Vec2 middle(view.fromWorld * Vec4(Vec3(sphere), 1));
        if (sphere.w >= whole)
            view.cascades.push_back(squareAbout({0, 0}, whole, options.size, guard(options), false));
        else  // a texel more: the square is moved by half of one
            view.cascades.push_back(squareAbout(middle, sphere.w, options.size, guard(options) + 1, true));
    }
}

/// Smallest and largest distance from a point to a box.
Vec2 distances(const Vec3& p, const Bounds& b) {
    const Vec3 nearest = glm::clamp(p, b.low, b.high);
    return {glm::length(nearest - p), glm::length(glm::max(glm::abs(b.low - p), glm::abs(b.high - p)))};
}

void fitPoint(ShadowView& view, const SceneShadow& options, const Light& light, const Bounds& scene) {
    const double content = 1 - 2 * guard(options) / options.size;
    if (light.cone && light.cone->outer <= kWidestSpot) {
        view.kind = ShadowKind::Spot;
        view.fromWorld = rigid(axesAlong(light.cone->axis), light.position);
        view.scale = content / std::tan(light.cone->outer);
        const Bounds box = moved(scene, view.fromWorld);
        fitPointRange(view, options, box.low.z, box.high.z);
        return;
    }
    view.kind = options.dualParaboloid ? ShadowKind::DualParaboloid : ShadowKind::Cube;
    view.scale = content;
    view.fromWorld = rigid(view.kind == ShadowKind::Cube ? Mat3(1) : axesAlong({0, -1, 0}), light.position);
    const Vec2 range = distances(light.position, scene);
    // Along a face's axis a point is up to √3 nearer than from the light.
    fitPointRange(view, options, view.kind == ShadowKind::Cube ? range.x / std::sqrt(3.0) : range.x, range.y);
}

}  // namespace

int ShadowView::layers() const {
    switch (kind) {
        case ShadowKind::Spot:
            return 1;
        case ShadowKind::Directional:
            return static_cast<int>(cascades.size());
        case ShadowKind::Cube:
            return 6;
        case ShadowKind::DualParaboloid:
            return 2;
    }
    throw std::invalid_argument("unknown kind of shadow map");
}

Bounds boundsOf(const Mesh& mesh, const glm::dmat4& toWorld) {
    Bounds out;
    for (const glm::vec3& p : mesh.positions) out.add(Vec3(toWorld * Vec4(Vec3(p), 1)));
    return out;
}

ShadowView fitShadow(const SceneShadow& options, const Light& light, const Bounds& scene, const Camera* camera,
                     double aspect) {
    check(options, light, scene, camera);
    ShadowView view;
    view.size = options.size;
    view.bits = options.bits;
    view.filter = options.filter;
    view.bias = options.bias;
    if (light.directional) {
        view.kind = ShadowKind::Directional;
        fitDirectional(view, options, light, scene, camera, aspect);
    } else {
        fitPoint(view, options, light, scene);
    }
    // Half a step of the stored depth, and what single precision leaves of positions in the world and from the light.
    const double range = view.far - view.near, step = options.bits == 16 ? 1.0 / 65535 : 1.0 / (1 << 24);
    const double world = std::max(glm::length(scene.low), glm::length(scene.high)) + glm::length(light.position);
    view.resolution = 0.5 * range * step + 8 * (world + std::abs(view.near) + range) / (1 << 24);
    // An error along the axis is a longer one along a slanted ray.
    if (view.kind == ShadowKind::Spot) view.resolution /= std::cos(light.cone->outer);
    if (view.kind == ShadowKind::Cube) view.resolution *= std::sqrt(3.0);
    return view;
}

Mat3 shadowLayerFrame(const ShadowView& view, int layer) {
    if (view.kind == ShadowKind::DualParaboloid)
        return layer == 0 ? Mat3(1) : glm::transpose(Mat3({-1, 0, 0}, {0, 1, 0}, {0, 0, -1}));
    if (view.kind != ShadowKind::Cube) return Mat3(1);
    static const Mat3 kRows[6] = {{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},  {{0, 0, -1}, {0, 1, 0}, {-1, 0, 0}},
                                  {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                  {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    return glm::transpose(kRows[layer]);
}

glm::dmat4 shadowClip(const ShadowView& view, int layer) {
    glm::dmat4 clip(0);
    if (view.kind == ShadowKind::Directional) {
        const Vec3& c = view.cascades[static_cast<std::size_t>(layer)];
        clip[0][0] = clip[1][1] = c.z;
        clip[3] = Vec4(c.x, c.y, -(view.far + view.near) / (view.far - view.near), 1);
        clip[2][2] = 2 / (view.far - view.near);
        return clip;
    }
    // Depth of the picture is written by the fragment; this one only clips.
    clip[0][0] = clip[1][1] = view.scale;
    clip[2] = Vec4(0, 0, (view.far + view.near) / (view.far - view.near), 1);
    clip[3][2] = -2 * view.far * view.near / (view.far - view.near);
    return clip;
}

}  // namespace nacre
