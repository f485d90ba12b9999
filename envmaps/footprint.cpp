#include "envmaps/footprint.hpp"

namespace nacre::footprint {

void clipSphere(const SpherePolygon& polygon, const Vec3& normal, SpherePolygon& out) {
    out.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const double dp = glm::dot(normal, p), dq = glm::dot(normal, q);
        if (dp >= 0) out.push_back(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0))
            out.push_back(glm::normalize(p * std::abs(dq) + q * std::abs(dp)));
    }
}

static bool hasSeam(EnvLayout layout) { return layout == EnvLayout::DualParaboloid || layout == EnvLayout::Octahedral; }

Footprints::Footprints(EnvLayout layout, int size) : layout_(layout), size_(size) {
    static constexpr int kCellsAcross = 16;                                   // of a hemisphere, a face or a square
    static constexpr double kLongestParabola = 0.03, kLongestChord = 0.0065;  // of an edge [rad]; errors of area ≤ 5e-6
    // A seamed map's size 1 has its only texel centre in the middle; [0.5, 1.5] of size 2 is the whole square.
    stretched_ = hasSeam(layout) && size == 1 ? 2 : size;
    offset_ = stretched_ == size ? 0 : 0.5;
    cells_ = (kCellsAcross + size - 1) / size;
    const bool straight = layout == EnvLayout::Cube || layout == EnvLayout::Octahedral;
    const double width = layout == EnvLayout::LatLong ? kPi / size : 4.0 / std::max(1, size - 1);
    segments_ = straight ? 1 : static_cast<int>(std::ceil(width / cells_ / kLongestParabola));
    bent_ = !straight && width / cells_ / segments_ > kLongestChord;
}

Vec3 Footprints::direction(const glm::dvec2& position, int block) const {
    if (layout_ == EnvLayout::LatLong || layout_ == EnvLayout::Octahedral)
        return envDirection(layout_, stretched_, position.x + offset_, position.y + offset_);
    // The last row of a face ends where the next face begins: stay on this side.
    const double last = std::nextafter(static_cast<double>((block + 1) * stretched_), 0.0);
    return envDirection(layout_, stretched_, position.x + offset_,
                        std::min(block * stretched_ + position.y + offset_, last));
}

/// The part of a plane polygon where a·x + b·y + c ≥ 0.
static std::vector<glm::dvec2> clipPlane(const std::vector<glm::dvec2>& polygon, const Vec3& line) {
    std::vector<glm::dvec2> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double dp = glm::dot(line, Vec3(p, 1)), dq = glm::dot(line, Vec3(q, 1));
        if (dp >= 0) out.push_back(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0))
            out.push_back((p * std::abs(dq) + q * std::abs(dp)) / (std::abs(dp) + std::abs(dq)));
    }
    return out;
}

/// Straight lines of the octahedral square are great circles within an octant: cut along the axes and folds.
void Footprints::appendOctants(const std::vector<glm::dvec2>& cell, std::vector<SpherePolygon>& out) const {
    const double middle = stretched_ / 2.0 - offset_, half = (stretched_ - 1) / 2.0;  // seam at middle ± half
    for (const double sx : {1.0, -1.0})
        for (const double sy : {1.0, -1.0})
            for (const double inside : {1.0, -1.0}) {
                std::vector<glm::dvec2> part = clipPlane(cell, {sx, 0, -sx * middle});
                part = clipPlane(part, {0, sy, -sy * middle});
                part = clipPlane(part, {-inside * sx, -inside * sy, inside * ((sx + sy) * middle + half)});
                if (part.size() < 3) continue;
                SpherePolygon& polygon = out.emplace_back();
                for (const glm::dvec2& p : part) polygon.push_back(direction(p, 0));
            }
}

void Footprints::appendCell(glm::dvec2 low, glm::dvec2 high, int block, std::vector<SpherePolygon>& out) const {
    if (layout_ == EnvLayout::Octahedral) {
        const glm::dvec2 first(0.5 - offset_), last(stretched_ - 0.5 - offset_);
        low = glm::clamp(low, first, last);
        high = glm::clamp(high, first, last);
        if (low.x < high.x && low.y < high.y) appendOctants({low, {high.x, low.y}, high, {low.x, high.y}}, out);
        return;
    }
    SpherePolygon& polygon = out.emplace_back();
    const glm::dvec2 corners[5] = {low, {high.x, low.y}, high, {low.x, high.y}, low};
    const auto at = [&](int side, double k) {
        const double t = k / segments_;
        return direction(corners[side] * (1 - t) + corners[side + 1] * t, block);
    };
    for (int side = 0; side < 4; ++side)
        for (int k = 0; k < segments_; ++k) {
            const Vec3 p = at(side, k);
            polygon.push_back(p);
            if (!bent_) continue;
            const Vec3 m = at(side, k + 0.5), chord = glm::normalize(p + at(side, k + 1));
            polygon.push_back(glm::normalize(m + (m - chord) / 3.0));  // a parabola holds 4/3 of its triangle
        }
}

void Footprints::append(int x, int y, std::vector<SpherePolygon>& out) const {
    const bool blocks = layout_ == EnvLayout::Cube || layout_ == EnvLayout::DualParaboloid;
    const int block = blocks ? y / size_ : 0;
    const double step = 1.0 / cells_;
    for (int b = 0; b < cells_; ++b)
        for (int a = 0; a < cells_; ++a) {
            const glm::dvec2 texel(x, y - block * size_);
            appendCell(texel + step * glm::dvec2(a, b), texel + step * glm::dvec2(a + 1, b + 1), block, out);
        }
}

}  // namespace nacre::footprint
