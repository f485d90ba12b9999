#include "factorize/separable_start.hpp"

#include <Eigen/Dense>
#include <array>

#include "core/parallel.hpp"

namespace nacre {
namespace {

using Matrix = Eigen::MatrixXf;
using Vector = Eigen::VectorXf;

/// The grid's values times both weights, a matrix a channel.
struct Weighted {
    std::array<Matrix, 3> values;
    Vector rows, columns;
};

Weighted tabulate(const SeparableGrid& grid) {
    const int n = grid.edge * grid.edge;
    const auto uvOf = [&](int i) { return glm::dvec2(i % grid.edge, i / grid.edge) / (grid.edge - 1.0); };
    Weighted out{{Matrix(n, n), Matrix(n, n), Matrix(n, n)}, Vector(n), Vector(n)};
    for (int i = 0; i < n; ++i) {
        out.rows[i] = static_cast<float>(grid.rowWeight(uvOf(i)));
        out.columns[i] = static_cast<float>(grid.columnWeight(uvOf(i)));
    }
    parallelFor(static_cast<std::size_t>(n), grid.threads, [&](std::size_t task) {
        const int column = static_cast<int>(task);
        for (int row = 0; row < n; ++row) {
            const Rgb f = grid.value(uvOf(row), uvOf(column));
            for (int c = 0; c < 3; ++c)
                out.values[c](row, column) = static_cast<float>(f[c]) * out.rows[row] * out.columns[column];
        }
    });
    return out;
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
    const Vector root = svd.singularValues().head(terms).cwiseSqrt();
    u = svd.matrixU().leftCols(terms) * root.asDiagonal();
    v = q * svd.matrixV().leftCols(terms) * root.asDiagonal();
}

const std::vector<glm::vec3> kRgb = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// The a and colour that take most of the symmetric matrices m with them: maximises |(aᵀ m_c a)_c| for |a| = 1.
struct Product {
    Vector a;
    glm::vec3 color{0};
};

Product leadingProduct(const std::array<Matrix, 3>& m) {
    constexpr int kRounds = 8;
    Product best;
    for (int start = 0; start < 4; ++start) {  // grey and each channel: alternation finds the nearest extremum only
        Product p;
        p.color = start == 0 ? glm::vec3(1) : kRgb[start - 1];
        for (int round = 0; round < kRounds; ++round) {
            const Matrix mixed = p.color.x * m[0] + p.color.y * m[1] + p.color.z * m[2];
            Matrix u, v;
            leadingPairs(mixed, 1, u, v);
            if (!(u.norm() > 1e-12f)) break;  // nothing left
            p.a = u.col(0).normalized();
            for (int c = 0; c < 3; ++c) p.color[c] = p.a.dot(m[c] * p.a);
        }
        if (p.a.size() > 0 && (best.a.size() == 0 || glm::length(p.color) > glm::length(best.color))) best = p;
    }
    if (best.a.size() == 0) best.a = Vector::Zero(m[0].rows());
    return best;
}

}  // namespace

std::vector<FitTable> singularPairs(const SeparableGrid& grid, int terms) {
    const Weighted m = tabulate(grid);
    std::vector<FitTable> out(2 * static_cast<std::size_t>(terms), FitTable(grid.edge, grid.edge, kRgb));
    for (int c = 0; c < 3; ++c) {
        Matrix u, v;
        leadingPairs(m.values[c], terms, u, v);
        for (int k = 0; k < terms; ++k)
            for (int i = 0; i < grid.edge * grid.edge; ++i) {
                out[2 * k].texels[3 * i + c] = u(i, k) / m.rows[i];
                out[2 * k + 1].texels[3 * i + c] = v(i, k) / m.columns[i];
            }
    }
    return out;
}

std::vector<FitTable> symmetricProducts(const SeparableGrid& grid, int tables) {
    Weighted m = tabulate(grid);
    for (Matrix& channel : m.values) channel = (0.5f * (channel + channel.transpose())).eval();
    std::vector<FitTable> out(static_cast<std::size_t>(tables),
                              FitTable(grid.edge, grid.edge, std::vector<glm::vec3>(4)));
    for (FitTable& table : out)
        for (int channel = 0; channel < 4; ++channel) {
            const Product p = leadingProduct(m.values);
            for (int c = 0; c < 3; ++c) m.values[c] -= p.color[c] * p.a * p.a.transpose();
            const float size = glm::length(p.color), root = std::sqrt(size);
            table.color[channel] = size > 0 ? p.color / size : glm::vec3(0);
            for (int i = 0; i < grid.edge * grid.edge; ++i) table.texels[4 * i + channel] = root * p.a[i] / m.rows[i];
        }
    return out;
}

}  // namespace nacre
