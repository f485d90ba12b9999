#include "envmaps/lobes.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"

namespace nacre {
namespace {

struct Named {
    LobeKind kind;
    const char* name;
};
constexpr std::array<Named, 8> kNames{{{LobeKind::Mirror, "mirror"},
                                       {LobeKind::Diffuse, "diffuse"},
                                       {LobeKind::Phong, "phong"},
                                       {LobeKind::Ggx, "ggx"},
                                       {LobeKind::Beckmann, "beckmann"},
                                       {LobeKind::GgxRefraction, "ggx_refraction"},
                                       {LobeKind::BeckmannRefraction, "beckmann_refraction"},
                                       {LobeKind::GgxAnisotropic, "ggx_anisotropic"}}};

/// D(θh)/D(0): GGX and Beckmann as ratios, so that no alpha overflows.
double ggx(double alpha, double sinH, double cosH) { return 1 / sqr(cosH * cosH + sqr(sinH / alpha)); }
double beckmann(double alpha, double sinH, double cosH) {
    const double c2 = cosH * cosH;
    return c2 > 0 ? std::exp(-sqr(sinH / alpha) / c2) / (c2 * c2) : 0;
}

using Distribution = double (*)(double, double, double);

/// θh beyond which Beckmann is below 1e-17: without an end, a lobe narrower than a texel would be given to harmonics,
/// whose rounding drowns it (isDirectBetter in prefilter.cpp).
double endOf(Distribution d, double alpha) { return d == beckmann ? std::atan(alpha * std::sqrt(40.0)) : kPi / 2; }

ZonalKernel reflection(Distribution d, double alpha) {
    const auto value = [=](double theta) {
        return theta < kPi / 2 ? d(alpha, std::sin(theta / 2), std::cos(theta / 2)) * std::cos(theta) : 0.0;
    };
    return {value, 2 * alpha, std::min(kPi / 2, 2 * endOf(d, alpha))};
}

/// θ = |θh − θt| with sinθt = sinθh/ior, solved for θh. With b = 1 − 1/ior, c = 2(1 − cosθ) and q² = b² + c/ior,
///   q sinθh = sinθ,  q cosθh = |b − c/2|,  q cosθt = |b + c/(2 ior)|,  cosθt · dθ/dθh = q,
/// where nothing is lost by an index near 1. Scaled to 1 at θ = 0.
ZonalKernel refraction(Distribution d, double alpha, double ior) {
    const double inverse = 1 / ior, bend = (ior - 1) / ior;
    const double edge = kPi / 2 - std::asin(std::min(ior, inverse));  // grazing facet, or total reflection
    const double thetaH = endOf(d, alpha), sinT = std::sin(thetaH) * inverse;
    const double support = sinT < 1 ? std::min(edge, std::abs(thetaH - std::asin(sinT))) : edge;
    const auto value = [=](double theta) {
        if (theta >= support) return 0.0;
        const double c = 4 * sqr(std::sin(theta / 2)), q = std::sqrt(sqr(bend) + inverse * c);
        const double sinH = std::sin(theta) / q, cosH = std::abs(bend - c / 2) / q;
        const double cosT = std::abs(bend + inverse * c / 2) / q;
        return sqr(bend / q) * d(alpha, sinH, cosH) * cosH * cosT * std::cos(theta);
    };
    return {value, std::min(alpha, 1.0) * std::abs(bend), support};
}

struct Nodes {
    std::array<double, 16> x, w;  ///< on [−1, 1]
};

/// Gauss–Legendre by Newton's method on P_16.
Nodes gaussNodes() {
    Nodes out{};
    constexpr int n = 16;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 20; ++step) {
            double before = 1, now = x;
            for (int k = 2; k <= n; ++k) {
                const double next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
                before = now;
                now = next;
            }
            slope = n * (x * now - before) / (x * x - 1);
            x -= now / slope;
        }
        out.x[i] = x;
        out.w[i] = 2 / ((1 - x * x) * slope * slope);
    }
    return out;
}

/// Calls visit(θ, dθ) over [0, support]: panels double away from the axis, and none is longer than P_order's waves ask.
void integrate(const ZonalKernel& kernel, int order, const std::function<void(double, double)>& visit) {
    static const Nodes nodes = gaussNodes();
    const double longest = 8.0 / (order + 8);
    double low = 0;
    while (low < kernel.support) {
        const double step = std::min(longest, std::max(kernel.width / 4, low / 2));
        const double high = low + step > kernel.support - step / 8 ? kernel.support : low + step;
        for (std::size_t i = 0; i < nodes.x.size(); ++i)
            visit(low + (high - low) * (nodes.x[i] + 1) / 2, nodes.w[i] * (high - low) / 2);
        low = high;
    }
}

}  // namespace

std::string toString(LobeKind kind) {
    for (const Named& n : kNames)
        if (n.kind == kind) return n.name;
    return "?";
}

std::vector<std::string> lobeNames() {
    std::vector<std::string> out;
    for (const Named& n : kNames) out.emplace_back(n.name);
    return out;
}

LobeKind lobeKindFromString(const std::string& name) {
    for (const Named& n : kNames)
        if (name == n.name) return n.kind;
    throw std::invalid_argument(fmt::format("unknown lobe '{}'; known: {}", name, fmt::join(lobeNames(), ", ")));
}

bool usesAlpha(LobeKind kind) {
    return kind == LobeKind::Ggx || kind == LobeKind::Beckmann || kind == LobeKind::GgxRefraction ||
           kind == LobeKind::BeckmannRefraction || kind == LobeKind::GgxAnisotropic;
}

bool isMirror(const Lobe& lobe) {
    const bool refracts = lobe.kind == LobeKind::GgxRefraction || lobe.kind == LobeKind::BeckmannRefraction;
    return lobe.kind == LobeKind::Mirror || (refracts && lobe.ior == 1);
}

bool isZonal(LobeKind kind) { return kind != LobeKind::Mirror && kind != LobeKind::GgxAnisotropic; }

void validateLobe(const Lobe& lobe) {
    require(lobe.kind != LobeKind::Phong || (std::isfinite(lobe.exponent) && lobe.exponent >= 0),
            fmt::format("phong: expected an exponent >= 0, found {}", lobe.exponent));
    require(!usesAlpha(lobe.kind) || (lobe.alpha > 0 && lobe.alpha <= 1),
            fmt::format("{}: expected alpha in (0, 1], found {}", toString(lobe.kind), lobe.alpha));
    if (lobe.kind == LobeKind::GgxAnisotropic) {
        require(lobe.alphaY > 0 && lobe.alphaY <= 1,
                fmt::format("ggx_anisotropic: expected alpha across the tangent in (0, 1], found {}", lobe.alphaY));
        require(isFinite(lobe.axis) && glm::length(lobe.axis) > 0,
                "ggx_anisotropic: expected a finite axis that is not 0");
    }
    const bool refracts = lobe.kind == LobeKind::GgxRefraction || lobe.kind == LobeKind::BeckmannRefraction;
    require(!refracts || (std::isfinite(lobe.ior) && lobe.ior > 0),
            fmt::format("{}: expected an index of refraction > 0, found {}", toString(lobe.kind), lobe.ior));
}

ZonalKernel zonalKernel(const Lobe& lobe) {
    validateLobe(lobe);
    switch (lobe.kind) {
        case LobeKind::Mirror:
        case LobeKind::GgxAnisotropic:
            break;
        case LobeKind::Diffuse:
            return {[](double t) { return std::max(0.0, std::cos(t)); }, 1, kPi / 2};
        case LobeKind::Phong: {
            const double n = lobe.exponent;
            const auto value = [n](double t) { return t < kPi / 2 ? std::exp(n * std::log(std::cos(t))) : 0.0; };
            // cosθ^n < e^−n θ²/2: beyond √(80/n) it is below 1e-17.
            return {value, 1 / std::sqrt(n + 1), std::min(kPi / 2, std::sqrt(80 / std::max(n, 1e-9)))};
        }
        case LobeKind::Ggx:
            return reflection(ggx, lobe.alpha);
        case LobeKind::Beckmann:
            return reflection(beckmann, lobe.alpha);
        case LobeKind::GgxRefraction:
            return refraction(ggx, lobe.alpha, lobe.ior);
        case LobeKind::BeckmannRefraction:
            return refraction(beckmann, lobe.alpha, lobe.ior);
    }
    throw std::invalid_argument(fmt::format("{}: it has no kernel by the angle alone", toString(lobe.kind)));
}

std::vector<double> zonalCoefficients(const ZonalKernel& kernel, int order) {
    std::vector<double> sums(static_cast<std::size_t>(order) + 1);
    integrate(kernel, order, [&](double theta, double step) {
        const double x = std::cos(theta), weight = kernel.value(theta) * std::sin(theta) * step;
        double before = 0, now = 1;
        for (int l = 0; l <= order; ++l) {
            sums[l] += weight * now;
            const double next = ((2 * l + 1) * x * now - l * before) / (l + 1);
            before = now;
            now = next;
        }
    });
    const double total = sums[0];
    for (double& sum : sums) sum /= total;
    return sums;
}

double zonalIntegral(const ZonalKernel& kernel) {
    double sum = 0;
    integrate(kernel, 0, [&](double theta, double step) { sum += kernel.value(theta) * std::sin(theta) * step; });
    return 2 * kPi * sum;
}

}  // namespace nacre
