#include "factorize/ward_phong.hpp"

#include <vector>

#include "core/error.hpp"

namespace nacre {
namespace {

/// A pair of directions, its solid angles, and what Ward says of it.
struct Pair {
    double cosDelta, ward, weight;
};

/// Half vectors where the lobe is (δ to five times its width), difference angles all round; dωi dωr = 4 cosθd dωh dωd.
std::vector<Pair> pairs(double alpha, double most) {
    constexpr int kDelta = 64, kTheta = 48, kPhi = 24;
    const double last = std::min(kPi / 2, std::atan(5 * alpha)), least = std::cos(most);
    std::vector<Pair> out;
    for (int i = 0; i < kDelta; ++i)
        for (int j = 0; j < kTheta; ++j)
            for (int k = 0; k < kPhi; ++k) {
                const double delta = last * (i + 0.5) / kDelta, theta = kPi / 2 * (j + 0.5) / kTheta,
                             phi = kPi * (k + 0.5) / kPhi;
                const Vec3 h(std::sin(delta), 0, std::cos(delta)), t(h.z, 0, -h.x);
                const Vec3 side = std::sin(theta) * (std::cos(phi) * t + std::sin(phi) * Vec3(0, 1, 0));
                const Vec3 wi = std::cos(theta) * h + side, wo = std::cos(theta) * h - side;
                if (wi.z < least || wo.z < least) continue;
                // φd covers half a turn: the other half is the mirror image.
                const double weight = 4 * std::cos(theta) * std::sin(delta) * std::sin(theta);
                out.push_back({h.z, wardSpecular(wi, wo, alpha), weight});
            }
    return out;
}

/// Best scale for an exponent, and the square error that is left.
std::pair<double, double> bestScale(const std::vector<Pair>& all, double exponent) {
    double wp = 0, pp = 0, ww = 0;
    for (const Pair& p : all) {
        const double power = std::pow(p.cosDelta, exponent);
        wp += p.weight * p.ward * power, pp += p.weight * power * power, ww += p.weight * p.ward * p.ward;
    }
    return {wp / pp, ww - wp * wp / pp};
}

void check(double alpha, double most) {
    require(alpha >= 0.01 && alpha <= 1, "cosine power: alpha must be in 0.01 to 1");
    require(most > 0 && most < kPi / 2, "cosine power: angles must end below a right angle");
}

}  // namespace

double CosinePower::operator()(const Vec3& wi, const Vec3& wo) const {
    if (wi.z <= 0 || wo.z <= 0) return 0;
    return scale * std::pow(glm::normalize(wi + wo).z, exponent);
}

double wardSpecular(const Vec3& wi, const Vec3& wo, double alpha) {
    if (wi.z <= 0 || wo.z <= 0) return 0;
    const double c = glm::normalize(wi + wo).z, tan2 = 1 / (c * c) - 1;
    return std::sqrt(wi.z / wo.z) * std::exp(-tan2 / sqr(alpha)) / (4 * kPi * sqr(alpha));
}

CosinePower paperCosinePower(double alpha) {
    const double n = 1.999 / sqr(alpha);
    return {0.0398 * n, n};
}

CosinePower fitCosinePower(double alpha, double most) {
    check(alpha, most);
    const std::vector<Pair> all = pairs(alpha, most);
    const double start = std::log(2 / sqr(alpha)), golden = 0.6180339887498949;
    double low = start - 2, high = start + 2;
    const auto left = [&](double logExponent) { return bestScale(all, std::exp(logExponent)).second; };
    for (int i = 0; i < 40; ++i) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (left(a) < left(b) ? high : low) = left(a) < left(b) ? b : a;
    }
    const double exponent = std::exp((low + high) / 2);
    return {bestScale(all, exponent).first, exponent};
}

double cosinePowerError(const CosinePower& p, double alpha, double most) {
    check(alpha, most);
    double off = 0, all = 0;
    for (const Pair& pair : pairs(alpha, most)) {
        off += pair.weight * sqr(p.scale * std::pow(pair.cosDelta, p.exponent) - pair.ward);
        all += pair.weight * sqr(pair.ward);
    }
    return std::sqrt(off / all);
}

double cosinePowerErrorAt(const CosinePower& p, double alpha, double thetaI, double most) {
    check(alpha, most);
    constexpr int kTheta = 400, kPhi = 200;
    const Vec3 wi(std::sin(thetaI), 0, std::cos(thetaI));
    double off = 0, all = 0;
    for (int i = 0; i < kTheta; ++i)
        for (int k = 0; k < kPhi; ++k) {
            const double theta = most * (i + 0.5) / kTheta, phi = kPi * (k + 0.5) / kPhi, s = std::sin(theta);
            const Vec3 wo(s * std::cos(phi), s * std::sin(phi), std::cos(theta));
            const double ward = wardSpecular(wi, wo, alpha);
            off += s * sqr(p(wi, wo) - ward), all += s * sqr(ward);
        }
    return std::sqrt(off / all);
}

}  // namespace nacre
