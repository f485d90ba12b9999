#include "reference/environment_error.hpp"

#include <random>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "envmaps/anisotropic_filter.hpp"
#include "reference/microfacet_terms.hpp"

namespace nacre {

namespace {

double distribution(bool beckmann, double cosH, double alpha) {
    if (cosH <= 0) return 0;
    const double c2 = cosH * cosH, tan2 = std::max(0.0, 1 - c2) / c2, a2 = alpha * alpha;
    if (beckmann) return std::exp(-tan2 / a2) / (kPi * a2 * c2 * c2);
    return a2 / (kPi * c2 * c2 * sqr(a2 + tan2));
}

double refractedWeight(const Lobe& lobe, bool beckmann, const Vec3& r, const Vec3& l) {
    const Vec3 n = -r, viewer = n;
    const double cosL = -glm::dot(l, n);  // the light comes from beyond the surface
    if (cosL <= 0) return 0;
    Vec3 h = -(viewer + lobe.ior * l);
    const double length = glm::length(h);
    if (length == 0) return 0;
    h /= lobe.ior > 1 ? length : -length;  // towards the viewer's side
    const double viewerH = glm::dot(viewer, h), lightH = glm::dot(l, h);
    if (viewerH <= 0 || lightH >= 0) return 0;
    const double jacobian = sqr(lobe.ior) * std::abs(lightH) / sqr(viewerH + lobe.ior * lightH);
    return distribution(beckmann, glm::dot(n, h), lobe.alpha) * glm::dot(n, h) * jacobian * cosL;
}

/// By the half vector's angles in the frame (tangent, bitangent, r).
double anisotropicWeight(const Lobe& lobe, const Vec3& r, const Vec3& l) {
    // Where r is along the axis the tangent is the baker's convention.
    const bool along = glm::length(glm::cross(r, lobe.axis)) < 1e-10 * glm::length(lobe.axis);
    const Vec3 b = glm::cross(r, along ? lobeTangent(lobe.axis, r) : lobe.axis), h = glm::normalize(l + r);
    const double length = glm::length(b);
    const double hy = glm::dot(h, b) / length, hx = glm::dot(h, glm::cross(b, r)) / length;
    const double theta = std::atan2(std::hypot(hx, hy), glm::dot(h, r));
    return terms::ggx(theta, std::atan2(hy, hx), lobe.alpha, lobe.alphaY) * glm::dot(r, l);
}

}  // namespace

double lobeWeight(const Lobe& lobe, const Vec3& r, const Vec3& l) {
    const double cosine = glm::dot(r, l);
    const bool beckmann = lobe.kind == LobeKind::Beckmann || lobe.kind == LobeKind::BeckmannRefraction;
    switch (lobe.kind) {
        case LobeKind::Diffuse:
            return std::max(0.0, cosine);
        case LobeKind::Phong:
            return cosine > 0 ? std::pow(cosine, lobe.exponent) : 0;
        case LobeKind::Ggx:
        case LobeKind::Beckmann:
            if (cosine <= 0) return 0;
            return distribution(beckmann, glm::dot(r, glm::normalize(l + r)), lobe.alpha) * cosine;
        case LobeKind::GgxRefraction:
        case LobeKind::BeckmannRefraction:
            return refractedWeight(lobe, beckmann, r, l);
        case LobeKind::GgxAnisotropic:
            return cosine > 0 ? anisotropicWeight(lobe, r, l) : 0;
        case LobeKind::Mirror:
            break;
    }
    throw std::invalid_argument("lobeWeight: a mirror has no weights");
}

EnvironmentTruth::EnvironmentTruth(const EnvMap& source, unsigned threads) : source_(&source) {
    const int size = source.size(), width = source.image.width();
    const std::vector<double> solidAngles = envSolidAngles(source.layout, size, threads);
    for (std::size_t i = 0; i < solidAngles.size(); ++i) {
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        if (solidAngles[i] > 0)
            texels_.push_back({envTexelDirection(source.layout, size, x, y), solidAngles[i], source.image.rgb(x, y)});
    }
}

Rgb EnvironmentTruth::operator()(const Lobe& lobe, const Vec3& r) const {
    Rgb sum(0);
    double weights = 0;
    for (const Texel& texel : texels_) {
        const double weight = lobeWeight(lobe, r, texel.direction) * texel.solidAngle;
        sum += weight * texel.radiance;
        weights += weight;
    }
    if (weights > 0) return sum / weights;
    const glm::dvec2 p = envPosition(source_->layout, source_->size(), r);
    return source_->image.rgb(std::clamp(static_cast<int>(p.x), 0, source_->image.width() - 1),
                              std::clamp(static_cast<int>(p.y), 0, source_->image.height() - 1));
}

namespace {
struct Spread {
    double rmse, p95, max;
};
Spread spreadOf(const std::vector<Rgb>& found, const std::vector<Rgb>& expected, double mean) {
    std::vector<double> errors;
    double squares = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            errors.push_back(std::abs(found[i][c] - expected[i][c]));
            squares += sqr(errors.back());
        }
    std::sort(errors.begin(), errors.end());
    const double count = static_cast<double>(errors.size());
    const auto relative = [mean](double e) { return mean > 0 ? e / mean : e; };  // a black map: absolute
    return {relative(std::sqrt(squares / count)), relative(errors[static_cast<std::size_t>(0.95 * (count - 1))]),
            relative(errors.back())};
}
}  // namespace

EnvironmentError measureEnvironment(const EnvMap& map, const EnvironmentTruth& truth, const Lobe& lobe, int samples,
                                    std::uint64_t seed, unsigned threads) {
    return measureEnvironment(map, drawEnvironmentSamples(map.layout, map.size(), truth, lobe, samples, seed, threads));
}

EnvironmentSamples drawEnvironmentSamples(EnvLayout layout, int size, const EnvironmentTruth& truth, const Lobe& lobe,
                                          int samples, std::uint64_t seed, unsigned threads) {
    require(samples >= 1, "measureEnvironment: samples must be >= 1");
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const glm::ivec2 extent = envExtent(layout, size);
    EnvironmentSamples out{layout, size, {}, {}, std::vector<Rgb>(2 * samples)};
    while (out.directions.size() < static_cast<std::size_t>(samples)) {
        const int x = static_cast<int>(uniform() * extent.x), y = static_cast<int>(uniform() * extent.y);
        if (envSolidAngle(layout, size, x, y) == 0) continue;
        out.texels.emplace_back(x, y);
        out.directions.push_back(envTexelDirection(layout, size, x, y));
    }
    for (int i = 0; i < samples; ++i) {
        const double z = 1 - 2 * uniform(), phi = 2 * kPi * uniform(), s = std::sqrt(std::max(0.0, 1 - z * z));
        out.directions.emplace_back(s * std::cos(phi), s * std::sin(phi), z);
    }
    parallelFor(out.directions.size(), threads,
                [&](std::size_t i) { out.expected[i] = truth(lobe, out.directions[i]); });
    return out;
}

EnvironmentError measureEnvironment(const EnvMap& map, const EnvironmentSamples& samples) {
    require(map.layout == samples.layout && map.size() == samples.size,
            "measureEnvironment: expected a map of the samples' layout and size");
    const std::size_t count = samples.texels.size();
    std::vector<Rgb> found;
    for (const glm::ivec2& texel : samples.texels) found.push_back(map.image.rgb(texel.x, texel.y));
    for (std::size_t i = count; i < samples.directions.size(); ++i)
        found.push_back(sampleEnv(map, samples.directions[i]));
    EnvironmentError out;
    out.samples = static_cast<int>(count);
    for (std::size_t i = 0; i < count; ++i) out.mean += mean(samples.expected[i]) / static_cast<double>(count);
    const auto part = [&](const std::vector<Rgb>& all, std::size_t first) {
        return std::vector<Rgb>(all.begin() + static_cast<std::ptrdiff_t>(first),
                                all.begin() + static_cast<std::ptrdiff_t>(first + count));
    };
    const Spread centres = spreadOf(part(found, 0), part(samples.expected, 0), out.mean);
    const Spread between = spreadOf(part(found, count), part(samples.expected, count), out.mean);
    out.rmse = centres.rmse, out.p95 = centres.p95, out.max = centres.max;
    out.filteredRmse = between.rmse, out.filteredP95 = between.p95, out.filteredMax = between.max;
    return out;
}

}  // namespace nacre
