#include "shading/multipass/specular_view.hpp"

#include <cmath>

namespace nacre {
namespace {

Vec4 row(const glm::dmat4& m, int i) { return {m[0][i], m[1][i], m[2][i], m[3][i]}; }
void setRow(glm::dmat4& m, int i, const Vec4& r) {
    for (int c = 0; c < 4; ++c) m[c][i] = r[c];
}

glm::dmat4 reflection(const Plane& plane) {
    const Vec3 n(plane);
    glm::dmat4 out(1);
    for (int c = 0; c < 4; ++c) out[c] -= 2.0 * plane[c] * Vec4(n, 0);
    return out;
}

}  // namespace

Vec3 towardsEye(const SpecularView& view, const Vec3& point) {
    return view.eye.w == 0 ? Vec3(view.eye) : glm::normalize(Vec3(view.eye) - point);
}

SpecularView viewOf(const Camera& camera, double aspect) {
    SpecularView out;
    out.toClip = camera.projection(aspect) * camera.view();
    out.eye = camera.orthographic ? Vec4(glm::normalize(camera.eye - camera.target), 0) : Vec4(camera.eye, 1);
    return out;
}

int sideOf(const SpecularView& view, const Plane& plane) {
    const double distance = glm::dot(plane, view.eye);
    // Rounding of the plane's and the eye's coordinates.
    const double scale = view.eye.w == 0 ? 1 : glm::length(Vec3(view.eye)) + std::abs(plane.w);
    return std::abs(distance) <= 1e-9 * scale ? 0 : distance > 0 ? 1 : -1;
}

SpecularView reflected(const SpecularView& view, const Plane& plane) {
    const glm::dmat4 mirror = reflection(plane);
    SpecularView out;
    out.toClip = view.toClip * mirror;
    out.eye = mirror * view.eye;
    out.clip = plane * double(sideOf(view, plane));
    out.mirrored = !view.mirrored;
    return out;
}

SpecularView refracted(const SpecularView& view, const Plane& plane, const Vec4& eye) {
    return seenFrom(view, plane, eye, -sideOf(view, plane), view.mirrored);
}

SpecularView seenFrom(const SpecularView& view, const Plane& plane, const Vec4& eye, int kept, bool mirrored) {
    const double distance = glm::dot(plane, eye);
    glm::dmat4 ontoPlane(1);
    for (int c = 0; c < 4; ++c) ontoPlane[c] -= plane[c] / distance * eye;
    SpecularView out;
    out.toClip = view.toClip * ontoPlane;
    out.eye = eye;
    out.clip = plane * double(kept);
    out.mirrored = mirrored;
    return out;
}

Vec3 planeAxis(const Plane& plane) {
    const Vec3 n(plane);
    return glm::normalize(glm::cross(std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0), n));
}

Vec4 shearedEye(const Vec4& eye, const Plane& plane, const Vec2& slope) {
    const Vec3 x = planeAxis(plane), along = slope.x * x + slope.y * glm::cross(Vec3(plane), x);
    Vec4 out = eye - Vec4(glm::dot(plane, eye) * along, 0);
    if (out.w == 0) out = Vec4(glm::normalize(Vec3(out)), 0);
    return out;
}

std::optional<Vec4> refractedEye(const SpecularView& view, const Plane& plane, const Vec3& point, double eta,
                                 RefractedEye how) {
    const Vec3 n = Vec3(plane) * double(sideOf(view, plane)), v = towardsEye(view, point);
    const double cosine = glm::dot(n, v);
    const Vec3 across = (v - cosine * n) / eta;  // sin θ' long
    const double cos2 = 1 - glm::dot(across, across);
    if (cos2 <= 0) return {};
    const Vec3 refractedWay = across + std::sqrt(cos2) * n;
    if (view.eye.w == 0) return Vec4(refractedWay, 0);
    const Vec3 eye(view.eye);
    if (how == RefractedEye::Turned) return Vec4(point + glm::length(eye - point) * refractedWay, 1);
    const double distance = std::abs(glm::dot(plane, view.eye));
    return Vec4(eye + n * (distance * (eta * std::sqrt(cos2) / cosine - 1)), 1);
}

void setDepths(SpecularView& view, double near, double far) {
    if (view.eye.w != 0) {
        const double a = (far + near) / (far - near), b = -2 * far * near / (far - near);
        setRow(view.toClip, 2, a * row(view.toClip, 3) + Vec4(0, 0, 0, b));
    } else {
        const Vec4 depth(-Vec3(view.eye), 0);
        setRow(view.toClip, 2, (2.0 * depth - Vec4(0, 0, 0, near + far)) / (far - near));
    }
}

void flattenDepths(SpecularView& view) { setRow(view.toClip, 2, Vec4(0)); }

double depthOf(const SpecularView& view, const Vec3& point) {
    return view.eye.w != 0 ? glm::dot(row(view.toClip, 3), Vec4(point, 1)) : -glm::dot(Vec3(view.eye), point);
}

std::optional<Vec3> planePointAt(const SpecularView& view, const Plane& plane, const Vec2& place) {
    // On the plane and on the planes of all points seen in that column and in that row: Cramer's rule.
    const Vec4 w = row(view.toClip, 3);
    const Vec4 column = row(view.toClip, 0) - place.x * w, line = row(view.toClip, 1) - place.y * w;
    const glm::dmat3 normals = glm::transpose(glm::dmat3(Vec3(column), Vec3(line), Vec3(plane)));
    const Vec3 right(-column.w, -line.w, -plane.w);
    const double determinant = glm::determinant(normals);
    if (determinant == 0) return {};
    const Vec3 point = glm::inverse(normals) * right;
    if (!isFinite(point) || (view.eye.w != 0 && !(depthOf(view, point) > 0))) return {};
    return point;
}

double incidentCosine(const SpecularView& view, const Plane& plane, const Vec3& point) {
    return std::abs(glm::dot(Vec3(plane), towardsEye(view, point)));
}

}  // namespace nacre
