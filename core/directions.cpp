#include "core/directions.hpp"

namespace nacre {

double angleBetween(const Vec3& a, const Vec3& b) { return 2.0 * std::atan2(glm::length(a - b), glm::length(a + b)); }

Vec3 halfVector(const Vec3& wi, const Vec3& wo) {
    const Vec3 sum = wi + wo;
    const double length = glm::length(sum);
    return length > 1e-12 ? sum / length : Vec3(0, 0, 1);
}

static double positiveAzimuth(double y, double x) {
    if (std::abs(x) < 1e-15 && std::abs(y) < 1e-15) return 0;
    const double phi = std::atan2(y, x);
    return phi < 0 ? phi + 2 * kPi : phi;
}

HalfDifference halfDifference(const Vec3& wi, const Vec3& wo) {
    const Vec3 h = halfVector(wi, wo);
    HalfDifference out;
    out.thetaH = angleBetween(h, Vec3(0, 0, 1));
    out.phiH = positiveAzimuth(h.y, h.x);
    // Rows of the rotation that takes h to the pole: first -phi_h about z, then -theta_h about y.
    const double cp = std::cos(out.phiH), sp = std::sin(out.phiH), ct = std::cos(out.thetaH), st = std::sin(out.thetaH);
    const Vec3 r(cp * wi.x + sp * wi.y, -sp * wi.x + cp * wi.y, wi.z);
    const Vec3 d(ct * r.x - st * r.z, r.y, st * r.x + ct * r.z);
    out.thetaD = angleBetween(wi, h);
    out.phiD = positiveAzimuth(d.y, d.x);
    return out;
}

DirectionPair fromHalfDifference(const HalfDifference& a) {
    const double ct = std::cos(a.thetaH), st = std::sin(a.thetaH), cp = std::cos(a.phiH), sp = std::sin(a.phiH);
    const auto toLocal = [&](const Vec3& d) {  // inverse rotation: +theta_h about y, then +phi_h about z
        const Vec3 r(ct * d.x + st * d.z, d.y, -st * d.x + ct * d.z);
        return Vec3(cp * r.x - sp * r.y, sp * r.x + cp * r.y, r.z);
    };
    const Vec3 d = sphericalDirection(a.thetaD, a.phiD);
    return {toLocal(d), toLocal(Vec3(-d.x, -d.y, d.z))};
}

}  // namespace nacre
