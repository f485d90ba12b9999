#include "factorize/mappings.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {

HalfGeometry halfGeometry(const glm::vec3& wi, const glm::vec3& wo) {
    HalfGeometry g;
    const glm::vec3 sum = wi + wo;
    g.h = sum / std::max(glm::length(sum), 1e-6f);
    g.lengthXY = std::sqrt(g.h.x * g.h.x + g.h.y * g.h.y);
    const glm::vec3 gap = wi - g.h;
    g.oneMinusLh = std::min(0.5f * glm::dot(gap, gap), 1.0f);
    return g;
}

glm::vec2 mapHalfDiff(const HalfGeometry& g, float s) {
    const float t = g.lengthXY / std::max(g.h.z, 1e-6f);
    return {std::sqrt(t / (t + s)), std::sqrt(g.oneMinusLh)};
}

float cosSquaredPhiD(const HalfGeometry& g, const glm::vec3& wi, const glm::vec3& wo) {
    const float gap = wi.z - wo.z;
    const float sinSquareD = g.oneMinusLh * (2.0f - g.oneMinusLh);
    const float denominator = std::max(4.0f * g.lengthXY * g.lengthXY * sinSquareD, 1e-4f);
    return std::clamp(gap * gap / denominator, 0.0f, 1.0f);
}

glm::vec2 mapElevations(float cosI, float cosO) {
    const float U = std::sqrt(std::clamp(1.0f - std::min(cosI, cosO), 0.0f, 1.0f));
    const float V = std::sqrt(std::clamp(1.0f - std::max(cosI, cosO), 0.0f, 1.0f));
    return {U, std::min(V / std::max(U, 1e-4f), 1.0f)};
}

constexpr float kSlopeMiddle = 1.5f;  // |m| that falls at ρ = 1/√2: the flank of a Gaussian lobe of width 1

static glm::vec2 foldDisk(const glm::vec2& p, bool quadrant) {
    return quadrant ? glm::min(glm::abs(p), glm::vec2(1.0f)) : glm::clamp(0.5f * p + 0.5f, 0.0f, 1.0f);
}

glm::vec2 mapScaledSlope(const glm::vec3& h, const glm::vec2& inverseWidth, bool quadrant) {
    const glm::vec2 m = glm::vec2(h.x, h.y) * inverseWidth / std::max(h.z, 1e-6f);
    const float length = std::sqrt(m.x * m.x + m.y * m.y);
    const float scale = 1.0f / std::sqrt(std::max(length, 1e-20f) * (length + kSlopeMiddle));  // ρ/|m|
    return foldDisk(m * scale, quadrant);
}

glm::vec2 mapLambertDisk(const glm::vec3& w, bool quadrant) {
    return foldDisk(glm::vec2(w.x, w.y) / std::sqrt(1.0f + std::max(w.z, 0.0f)), quadrant);
}

float mapLobe(float oneMinusS, float w0) {
    const float w = std::sqrt(std::clamp(oneMinusS, 0.0f, 1.0f));
    return w / (w + w0) * (1.0f + w0);
}

glm::vec3 differenceVector(const glm::vec3& h, const glm::vec3& wi) {
    // Gram–Schmidt frame about h: x axis from the normal's projection; any axis where h is the normal.
    const float sinH = std::sqrt(h.x * h.x + h.y * h.y);
    const glm::vec2 azimuth = sinH > 1e-6f ? glm::vec2(h.x, h.y) / sinH : glm::vec2(1, 0);
    const glm::vec3 x(azimuth.x * h.z, azimuth.y * h.z, -sinH), y(-azimuth.y, azimuth.x, 0);
    return {glm::dot(wi, x), glm::dot(wi, y), glm::dot(wi, h)};
}

glm::vec3 carriedDifference(const glm::vec3& h, const glm::vec3& wi) {
    const float cosD = glm::dot(wi, h);
    const float along = (cosD + wi.z) / (1.0f + h.z);  // v − v·(h + z)/(1 + h·z) (h + z) + 2 (v·h) z
    return {wi.x - along * h.x, wi.y - along * h.y, cosD};
}

float smithDenominator(SmithShadowing shadowing, const glm::vec2& width, const glm::vec3& wi, const glm::vec3& wo) {
    if (shadowing == SmithShadowing::None) return 1;
    const glm::vec3 scale(width, 1.0f);
    const float si = glm::length(scale * wi), so = glm::length(scale * wo);
    return shadowing == SmithShadowing::Correlated ? wo.z * si + wi.z * so : (wi.z + si) * (wo.z + so);
}

double inverseHalfDiffSlope(double u, double s) { return s * u * u / (1 - u * u); }

double inverseHalfDiffCosine(double v) { return 1 - v * v; }

ElevationPair inverseElevations(double U, double V) { return {1 - U * U, 1 - U * U * V * V}; }

static glm::dvec2 unfoldDisk(const glm::dvec2& uv, bool quadrant) { return quadrant ? uv : uv * 2.0 - 1.0; }

glm::dvec3 inverseScaledSlope(const glm::dvec2& uv, const glm::dvec2& width, bool quadrant) {
    glm::dvec2 p = unfoldDisk(uv, quadrant);
    const double square = std::min(glm::dot(p, p), 0.9999);  // corners of the square lie outside the disk: its rim
    if (glm::dot(p, p) > square) p *= std::sqrt(square / glm::dot(p, p));
    if (square < 1e-24) return {0, 0, 1};
    const double length = kSlopeMiddle * square / (1 - square);  // |m| of ρ² = |m|/(|m| + middle)
    const glm::dvec2 m = p / std::sqrt(square) * length * width;
    return glm::normalize(glm::dvec3(m.x, m.y, 1));
}

glm::dvec3 inverseLambertDisk(const glm::dvec2& uv, bool quadrant) {
    glm::dvec2 p = unfoldDisk(uv, quadrant);
    const double square = std::min(glm::dot(p, p), 1.0);
    if (glm::dot(p, p) > 1) p /= std::sqrt(glm::dot(p, p));
    const double z = 1 - square;
    return {p.x * std::sqrt(1 + z), p.y * std::sqrt(1 + z), z};
}

double inverseLobe(double u, double w0) {
    const double w = u * w0 / (1 + w0 - u);  // u (w + w0) = w (1 + w0)
    return 1 - w * w;
}

}  // namespace nacre
