#include "reference/fermat_path.hpp"

#include <array>

namespace nacre {
namespace {

using Mat2 = glm::dmat2;
using Basis = std::array<Vec3, 2>;

Basis across(const Vec3& n) {
    const Vec3 x = glm::normalize(glm::cross(std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0), n));
    return {x, glm::cross(n, x)};
}

/// Of the plane, on the line from a to b; between their feet where the line doesn't cross it.
Vec3 startOn(const Vec4& plane, const Vec3& a, const Vec3& b) {
    const double da = glm::dot(plane, Vec4(a, 1)), db = glm::dot(plane, Vec4(b, 1));
    const double t = da * db < 0 ? da / (da - db) : 0.5;
    const Vec3 p = glm::mix(a, b, t);
    return p - glm::dot(plane, Vec4(p, 1)) * Vec3(plane);
}

/// Between two points: n / l (I − t tᵀ) is the length's second derivative.
struct Segment {
    Vec3 t{0};
    double length = 0, index = 1;

    Mat2 between(const Basis& a, const Basis& b) const {
        Mat2 out;
        for (int c = 0; c < 2; ++c)
            for (int r = 0; r < 2; ++r)
                out[c][r] = index / length * (glm::dot(a[r], b[c]) - glm::dot(a[r], t) * glm::dot(t, b[c]));
        return out;
    }
};

class Solver {
public:
    Solver(const Vec3& from, const Vec3& to, const std::vector<RefractingPlane>& planes) : points_{from} {
        indices_.push_back(1);
        for (const RefractingPlane& p : planes) {
            points_.push_back(startOn(p.plane, from, to));
            bases_.push_back(across(Vec3(p.plane)));
            indices_.push_back(indices_.back() * p.eta);
        }
        points_.push_back(to);
        count_ = planes.size();
    }

    bool solve() {
        if (!measure(points_)) return false;
        static constexpr int kSteps = 100;
        for (int step = 0; step < kSteps; ++step) {
            std::vector<Vec2> down;
            double steepest = 0;
            for (std::size_t j = 0; j < count_; ++j) {
                const Segment &in = segments_[j], &out = segments_[j + 1];
                const Vec3 g = in.index * in.t - out.index * out.t;
                down.emplace_back(-glm::dot(bases_[j][0], g), -glm::dot(bases_[j][1], g));
                steepest = std::max(steepest, glm::length(down.back()) / out.index);
            }
            if (steepest < 1e-11) return true;
            solveBlocks(down);
            const std::vector<Vec3> before = points_;
            const double length = length_;
            bool fell = false;
            for (double scale = 1; scale > 1e-9 && !fell; scale *= 0.5) {
                for (std::size_t j = 0; j < count_; ++j)
                    points_[j + 1] = before[j + 1] + scale * (down[j].x * bases_[j][0] + down[j].y * bases_[j][1]);
                fell =
                    measure(points_) && length_ <= length * (1 + 1e-14);  // near the end its fall is lost in rounding
            }
            if (!fell) return false;
        }
        return false;
    }

    FermatPath result() {
        const Segment &first = segments_.front(), &last = segments_.back();
        const Basis u = across(first.t), v = across(last.t);
        FermatPath out;
        out.points.assign(points_.begin() + 1, points_.end() - 1);
        Mat2 mixed = -first.between(u, v);
        if (count_ > 0) {
            Mat2 columns = last.between(bases_.back(), v);  // −∂²F/∂q∂v
            for (int c = 0; c < 2; ++c) {
                std::vector<Vec2> right(count_, Vec2(0));
                right.back() = columns[c];
                solveBlocks(right);
                mixed[c] = -first.between(u, bases_.front()) * right.front();
            }
        }
        out.spread = std::abs(glm::determinant(mixed));
        return out;
    }

private:
    bool measure(const std::vector<Vec3>& points) {
        segments_.resize(count_ + 1);
        length_ = 0;
        for (std::size_t s = 0; s <= count_; ++s) {
            const Vec3 d = points[s + 1] - points[s];
            const double l = glm::length(d);
            if (!(l > 0)) return false;
            segments_[s] = {d / l, l, indices_[s]};
            length_ += indices_[s] * l;
        }
        return true;
    }

    /// Solves H x = x: H is symmetric, of 2 × 2 blocks along the diagonal and beside it (Thomas's algorithm).
    void solveBlocks(std::vector<Vec2>& x) const {
        std::vector<Mat2> pivot(count_);
        for (std::size_t j = 0; j < count_; ++j) {
            pivot[j] = segments_[j].between(bases_[j], bases_[j]) + segments_[j + 1].between(bases_[j], bases_[j]);
            if (j == 0) continue;
            const Mat2 beside = segments_[j].between(bases_[j], bases_[j - 1]);  // times −1
            const Mat2 factor = beside * glm::inverse(pivot[j - 1]);
            pivot[j] -= factor * glm::transpose(beside);
            x[j] += factor * x[j - 1];
        }
        for (std::size_t j = count_; j-- > 0;) {
            if (j + 1 < count_) x[j] += segments_[j + 1].between(bases_[j], bases_[j + 1]) * x[j + 1];
            x[j] = glm::inverse(pivot[j]) * x[j];
        }
    }

    std::vector<Vec3> points_;
    std::vector<Basis> bases_;
    std::vector<double> indices_;
    std::vector<Segment> segments_;
    std::size_t count_ = 0;
    double length_ = 0;
};

}  // namespace

std::optional<FermatPath> fermatPath(const Vec3& from, const Vec3& to, const std::vector<RefractingPlane>& planes) {
    Solver solver(from, to, planes);
    if (!solver.solve()) return {};
    return solver.result();
}

}  // namespace nacre
