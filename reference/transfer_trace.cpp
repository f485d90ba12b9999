#include "reference/transfer_trace.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "envmaps/spherical_harmonics.hpp"
#include "reference/embree_scene.hpp"

namespace nacre {
namespace {

double extent(std::span<const glm::vec3> positions) {
    glm::dvec3 low(positions[0]), high = low;
    for (const glm::vec3& p : positions) {
        low = glm::min(low, glm::dvec3(p));
        high = glm::max(high, glm::dvec3(p));
    }
    return maxComponent(high - low);
}

/// Legendre's P_l(x).
double legendre(int l, double x) {
    double before = 1, here = x;
    if (l == 0) return before;
    for (int k = 1; k < l; ++k) {
        const double next = ((2 * k + 1) * x * here - k * before) / (k + 1);
        before = here;
        here = next;
    }
    return here;
}

/// 2 ∫₀¹ P_l(x) x dx: by Funk–Hecke the clamped cosine over π turns y_lm(s) into this times y_lm(n).
double cosineFactor(int l) {
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = (i + 0.5) / kSteps;
        sum += legendre(l, x) * 2 * x / kSteps;
    }
    return sum;
}

}  // namespace

Mesh meshOfExtentOne(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions) {
    Mesh mesh;
    const double size = positions.empty() ? 0 : extent(positions), scale = size > 0 ? 1 / size : 1;
    for (const glm::vec3& p : positions)
        mesh.positions.emplace_back(scale * (glm::dvec3(p) - glm::dvec3(positions[0])));
    mesh.triangles.assign(triangles.begin(), triangles.end());
    return mesh;
}

std::vector<double> tracedTransfer(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
                                   std::span<const glm::vec3> normals, std::span<const std::uint32_t> vertices,
                                   int order, std::size_t rays) {
    require(order >= 0 && rays >= 1, "traced transfer: expected an order of 0 or more and at least one ray");
    require(normals.size() == positions.size(), "traced transfer: expected a normal a position");
    const Mesh mesh = meshOfExtentOne(triangles, positions);
    const EmbreeScene scene(mesh);
    constexpr double kFar = 1e3;
    const std::size_t count = static_cast<std::size_t>((order + 1) * (order + 1));
    std::vector<double> factors;
    for (int l = 0; l <= order; ++l) factors.push_back(cosineFactor(l));
    std::vector<double> truth(vertices.size() * count, 0);
    parallelFor(vertices.size(), 0, [&](std::size_t i) {
        const Vec3 n = normals[vertices[i]], p = Vec3(mesh.positions[vertices[i]]) + kTransferLift * n;
        if (n == Vec3(0)) return;
        const Vec3 side = std::abs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
        const Vec3 t = glm::normalize(glm::cross(side, n)), b = glm::cross(n, t);
        const Vec2 shift(radicalInverse(vertices[i] + 1, 3), radicalInverse(vertices[i] + 1, 5));
        std::vector<double> hidden(count, 0);
        for (std::size_t k = 0; k < rays; ++k) {
            const Vec2 point =
                Vec2((static_cast<double>(k) + 0.5) / static_cast<double>(rays), radicalInverse(k, 2)) + shift;
            const Vec3 d = cosineHemisphere(point - glm::floor(point)), s = d.x * t + d.y * b + d.z * n;
            if (!scene.occluded({p, s, 0, kFar})) continue;
            const std::vector<double> y = realHarmonics(order, s);
            for (std::size_t c = 0; c < count; ++c) hidden[c] += y[c];
        }
        const std::vector<double> about = realHarmonics(order, n);
        for (int l = 0; l <= order; ++l)
            for (std::size_t c = static_cast<std::size_t>(l * l); c < static_cast<std::size_t>((l + 1) * (l + 1)); ++c)
                truth[i * count + c] =
                    factors[static_cast<std::size_t>(l)] * about[c] - hidden[c] / static_cast<double>(rays);
    });
    return truth;
}

TransferError transferError(std::span<const float> found, std::span<const double> truth, std::size_t coefficients) {
    require(coefficients > 0 && found.size() == truth.size() && truth.size() % coefficients == 0,
            "transfer error: expected as many coefficients as the truth has");
    double openSquared = 0;  // |V| of an open vertex: Σ factor² (2l + 1)/4π, its order from the count
    for (int l = 0; static_cast<std::size_t>(l * l) < coefficients; ++l)
        openSquared += sqr(cosineFactor(l)) * (2 * l + 1) / (4 * kPi);
    TransferError error;
    double offSquared = 0, allSquared = 0;
    std::vector<double> relative;
    for (std::size_t v = 0; v < truth.size() / coefficients; ++v) {
        double off = 0, all = 0;
        for (std::size_t c = v * coefficients; c < (v + 1) * coefficients; ++c) {
            off += sqr(found[c] - truth[c]);
            all += sqr(truth[c]);
        }
        offSquared += off;
        allSquared += all;
        if (all < 1e-4 * openSquared)
            ++error.buried;
        else
            relative.push_back(std::sqrt(off / all));
    }
    error.vertices = relative.size();
    error.total = allSquared > 0 ? std::sqrt(offSquared / allSquared) : 0;
    if (relative.empty()) return error;
    std::sort(relative.begin(), relative.end());
    for (const double r : relative) error.mean += r / static_cast<double>(relative.size());
    error.median = relative[relative.size() / 2];
    error.p95 = relative[relative.size() * 95 / 100];
    return error;
}

}  // namespace nacre
