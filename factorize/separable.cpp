// Method `svd`: f = Σ_k U_k(x) V_k(y), Kautz & McCool 1999, over (half vector, difference vector) or (wi, wo). The
// leading singular pairs come from subspace iteration, one colour channel after the other.
#include <fmt/format.h>
#include <Eigen/Dense>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "factorize/fit_samples.hpp"
#include "factorize/mappings.hpp"
#include "factorize/methods.hpp"

namespace nacre {
namespace {

using Matrix = Eigen::MatrixXf;

struct Layout {
    bool inOut = false;
    int edge = 32;
    double width = 0.3;
};

/// Directions of texel pair (row texel of x, column texel of y).
void directionsOf(const Layout& layout, const glm::dvec2& x, const glm::dvec2& y, Vec3& wi, Vec3& wo) {
    if (layout.inOut) {
        wi = inverseLambertDisk(x, false);
        wo = inverseLambertDisk(y, false);
        return;
    }
    const Vec3 h = inverseScaledSlope(x, glm::dvec2(layout.width), false), d = inverseLambertDisk(y, false);
    const double sinH = std::hypot(h.x, h.y);
    const Vec2 a = sinH > 1e-12 ? Vec2(h.x, h.y) / sinH : Vec2(1, 0);
    const Vec3 ex(a.x * h.z, a.y * h.z, -sinH), ey(-a.y, a.x, 0);
    wi = d.x * ex + d.y * ey + d.z * h;
    wo = 2 * glm::dot(wi, h) * h - wi;
}

constexpr double kLowest = 0.17;  // cos 80°: grazing values grow without bound and would be all the SVD looks at

/// Pairs below 80° take the value of their directions lifted to it: the tables stay smooth where nobody looks.
Rgb valueAt(const Reflectance& r, Vec3 wi, Vec3 wo) {
    const auto lift = [](Vec3& w) {
        if (w.z < kLowest) w = glm::normalize(Vec3(w.x, w.y, kLowest));
    };
    lift(wi);
    lift(wo);
    return r.f(wi, wo);
}

std::array<Matrix, 3> tabulate(const Reflectance& r, const Layout& layout, unsigned threads) {
    const int n = layout.edge * layout.edge;
    std::array<Matrix, 3> m{Matrix(n, n), Matrix(n, n), Matrix(n, n)};
    const auto uvOf = [&](int i) { return glm::dvec2(i % layout.edge, i / layout.edge) / (layout.edge - 1.0); };
    parallelFor(static_cast<std::size_t>(n), threads, [&](std::size_t column) {
        for (int row = 0; row < n; ++row) {
            Vec3 wi, wo;
            directionsOf(layout, uvOf(row), uvOf(static_cast<int>(column)), wi, wo);
            const Rgb f = valueAt(r, wi, wo);
            for (int c = 0; c < 3; ++c) m[c](row, static_cast<int>(column)) = static_cast<float>(f[c]);
        }
    });
    return m;
}

/// Leading `terms` pairs (U √σ, V √σ) of m by subspace iteration with a small oversampling.
void leadingPairs(const Matrix& m, int terms, Matrix& u, Matrix& v) {
    constexpr int kSweeps = 12, kExtra = 4;
    const int k = terms + kExtra;
    Matrix q = Matrix::NullaryExpr(m.cols(), k, [&](Eigen::Index i, Eigen::Index j) {
        return std::cos(static_cast<float>((i + 1) * j) * 3.14159265f / static_cast<float>(m.cols()));
    });
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        const Matrix left = Eigen::HouseholderQR<Matrix>(m * q).householderQ() * Matrix::Identity(m.rows(), k);
        q = Eigen::HouseholderQR<Matrix>(m.transpose() * left).householderQ() * Matrix::Identity(m.cols(), k);
    }
    const Eigen::JacobiSVD<Matrix> svd(m * q, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Eigen::VectorXf root = svd.singularValues().head(terms).cwiseSqrt();
    u = svd.matrixU().leftCols(terms) * root.asDiagonal();
    v = q * svd.matrixV().leftCols(terms) * root.asDiagonal();
}

}  // namespace

FactoredBrdf factorizeSeparable(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options) {
    const int terms = options.terms == 0 ? 2 : options.terms;
    require(terms == 1 || terms == 2, "factorize: svd takes 1 or 2 terms");
    const std::string& name = options.parametrization;
    require(name.empty() || name == "half_diff" || name == "in_out",
            fmt::format("unknown parametrization '{}'; known: half_diff, in_out", name));
    require(sizes.first.x <= 48, "factorize: svd takes sizes up to 48: its matrix has size^4 entries");
    Layout layout{name == "in_out", sizes.first.x, 0.3};
    layout.width = r.microfacet ? std::clamp(std::sqrt(r.microfacet->alphaX * r.microfacet->alphaY), 1e-3, 1.0)
                                : std::clamp(lobeHalfWidth(r.f), 0.02, 0.7);
    report(options.progress, "tabulating", 0.1);
    const std::array<Matrix, 3> m = tabulate(r, layout, options.threads);

    FactoredBrdf out;
    out.form = FactoredForm::Separable;
    out.method = "svd";
    out.params[0] = {static_cast<float>(terms), layout.inOut, 0, 0};
    out.params[1] = glm::vec4(1 / layout.width, 1 / layout.width, 0, 0);
    std::vector<Image> images(2 * terms, Image(layout.edge, layout.edge, 3));
    for (int c = 0; c < 3; ++c) {
        Matrix u, v;
        leadingPairs(m[c], terms, u, v);
        for (int k = 0; k < terms; ++k)
            for (int i = 0; i < layout.edge * layout.edge; ++i) {
                images[2 * k].data()[3 * i + c] = u(i, k);
                images[2 * k + 1].data()[3 * i + c] = v(i, k);
            }
        report(options.progress, "decomposing", 0.3 + 0.2 * c);
    }
    const char* x = layout.inOut ? "lambert_disk" : "scaled_slope";
    for (int k = 0; k < terms; ++k) {
        out.textures.push_back(makeScaledTexture(fmt::format("u{}", k), x, std::move(images[2 * k]), options.format));
        out.textures.push_back(
            makeScaledTexture(fmt::format("v{}", k), "lambert_disk", std::move(images[2 * k + 1]), options.format));
    }
    out.fetches = 2 * terms;
    return out;
}

}  // namespace nacre
