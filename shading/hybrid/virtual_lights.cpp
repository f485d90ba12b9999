#include "shading/hybrid/virtual_lights.hpp"

#include <algorithm>
#include <array>
#include <queue>

#include "core/error.hpp"

namespace nacre {
namespace {

using Index = std::size_t;
using Six = std::array<double, 6>;

struct Group {
    std::vector<Index> elements;
    Six mean{};
    double spread = 0;  ///< power · variance
    std::size_t axis = 0;
    bool operator<(const Group& other) const { return spread < other.spread; }
};

/// The rectangle with the elements' mean, variances and area. That of a half width a has the variance a²/3.
void setRectangle(VirtualPointLight& light, const SceneElements& elements, std::span<const Index> members) {
    const Vec3& n = light.normal;
    Vec3 axis(0);  // groups are cut across the world's axes
    int across = 0;
    for (int c = 1; c < 3; ++c)
        if (std::abs(n[c]) < std::abs(n[across])) across = c;
    axis[across] = 1;
    const Vec3 u = glm::normalize(axis - glm::dot(axis, n) * n), v = glm::cross(n, u);
    double area = 0, uu = 0, vv = 0;
    Vec3 mean(0);
    for (const Index i : members) {
        area += elements.elements[i].area;
        mean += elements.elements[i].area * elements.elements[i].centre;
    }
    mean /= area;
    for (const Index i : members) {
        const Vec3 d = elements.elements[i].centre - mean;
        // a small triangle's own variance is about that of a square of its area: area / 12
        const double own = elements.elements[i].area / 12, share = elements.elements[i].area / area;
        uu += share * (sqr(glm::dot(d, u)) + own);
        vv += share * (sqr(glm::dot(d, v)) + own);
    }
    const double fit = std::sqrt(area / (12 * std::sqrt(uu * vv)));
    light.place = mean + glm::dot(light.position - mean, n) * n;
    light.u = fit * std::sqrt(3 * uu) * u;
    light.v = fit * std::sqrt(3 * vv) * v;
}

/// Lambert's: half the sum over edges of the angle that they span, times the cosine between n and the plane through
/// edge and point; over π. \param middle  of the rectangle, from the point
double rectangleFactor(const Vec3& middle, const Vec3& u, const Vec3& v, const Vec3& n) {
    const Vec3 corners[] = {glm::normalize(middle - u - v), glm::normalize(middle - u + v),
                            glm::normalize(middle + u + v), glm::normalize(middle + u - v)};
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const Vec3 across = glm::cross(corners[i], corners[(i + 1) % 4]);
        const double sine = glm::length(across);
        if (sine > 0) sum += std::atan2(sine, glm::dot(corners[i], corners[(i + 1) % 4])) * glm::dot(across, n) / sine;
    }
    return std::max(0.0, sum / (2 * kPi));
}

class Grouping {
public:
    Grouping(const SceneElements& elements, std::span<const Rgb> power)
        : elements_(elements),
          power_(power),
          perNormal_(0.25 * glm::length(elements.bounds.high - elements.bounds.low)) {}

    std::vector<VirtualPointLight> lights(std::vector<Index> reflecting, int count) const {
        std::priority_queue<Group> groups;
        groups.push(made(std::move(reflecting)));
        std::vector<VirtualPointLight> out;
        while (!groups.empty()) {
            const bool enough = static_cast<int>(groups.size()) + static_cast<int>(out.size()) >= count;
            Group top = groups.top();
            groups.pop();
            if (enough || !(top.spread > 0)) {
                out.push_back(light(top));
                continue;
            }
            const auto upper = std::partition(top.elements.begin(), top.elements.end(),
                                              [&](Index i) { return at(i)[top.axis] < top.mean[top.axis]; });
            if (upper == top.elements.begin() || upper == top.elements.end()) {  // equal but for rounding
                out.push_back(light(top));
                continue;
            }
            groups.push(made({top.elements.begin(), upper}));
            groups.push(made({upper, top.elements.end()}));
        }
        return out;
    }

private:
    Six at(Index i) const {
        const SceneElement& e = elements_.elements[i];
        return {e.centre.x,
                e.centre.y,
                e.centre.z,
                perNormal_ * e.normal.x,
                perNormal_ * e.normal.y,
                perNormal_ * e.normal.z};
    }

    Group made(std::vector<Index> members) const {
        Group out;
        Six squares{};
        double total = 0;
        for (const Index i : members) {
            const double weight = luminance(power_[i]);
            const Six x = at(i);
            for (std::size_t k = 0; k < 6; ++k) out.mean[k] += weight * x[k], squares[k] += weight * x[k] * x[k];
            total += weight;
        }
        Six variance{};
        for (std::size_t k = 0; k < 6; ++k) {
            out.mean[k] /= total;
            variance[k] = std::max(0.0, squares[k] / total - sqr(out.mean[k]));
            out.spread += total * variance[k];
        }
        if (members.size() == 1) out.spread = 0;
        out.axis = static_cast<std::size_t>(std::max_element(variance.begin(), variance.end()) - variance.begin());
        out.elements = std::move(members);
        return out;
    }

    VirtualPointLight light(const Group& group) const {
        VirtualPointLight out;
        double least = 1e300;
        Index nearest = group.elements.front();
        for (const Index i : group.elements) {
            const Six x = at(i);
            double distance = 0;
            for (std::size_t k = 0; k < 6; ++k) distance += sqr(x[k] - group.mean[k]);
            if (distance < least) least = distance, nearest = i;
            out.power += power_[i];
        }
        out.position = elements_.elements[nearest].centre;
        out.normal = elements_.elements[nearest].normal;
        setRectangle(out, elements_, group.elements);
        return out;
    }

    const SceneElements& elements_;
    std::span<const Rgb> power_;
    double perNormal_;
};

}  // namespace

Vec2 virtualLightGeometry(const VirtualPointLight& light, const Vec3& place, const Vec3& n, NearLight near) {
    const Vec3 offset = light.place - place;
    const double square = std::max(glm::dot(offset, offset), 1e-12), towards = -glm::dot(light.normal, offset);
    const double cosines = std::max(glm::dot(n, offset), 0.0) * std::max(towards, 0.0) / square;
    const double point = cosines / square;
    if (near == NearLight::Point) return {point, point};
    if (near == NearLight::Rectangle && towards > 0 &&
        square < 16 * (glm::dot(light.u, light.u) + glm::dot(light.v, light.v)))
        return {kPi / light.area() * rectangleFactor(offset, light.u, light.v, n), point};
    return {cosines / (square + light.area() / kPi), point};
}

VirtualLights chooseVirtualLights(const SceneElements& elements, std::span<const Rgb> power, int count,
                                  VirtualLightChoice choice) {
    require(power.size() == elements.elements.size(), "virtual lights: expected a power for each element");
    require(count >= 1, "virtual lights: expected at least one");
    std::vector<Index> reflecting;
    double all = 0;
    for (Index i = 0; i < power.size(); ++i) {
        if (!(luminance(power[i]) > 0)) continue;
        reflecting.push_back(i);
        all += luminance(power[i]);
    }
    VirtualLights out;
    if (reflecting.empty()) return out;
    if (choice == VirtualLightChoice::Grouped) {
        out.lights = Grouping(elements, power).lights(std::move(reflecting), count);
        return out;
    }
    const auto kept = static_cast<std::ptrdiff_t>(std::min(reflecting.size(), static_cast<Index>(count)));
    std::partial_sort(reflecting.begin(), reflecting.begin() + kept, reflecting.end(), [&](Index a, Index b) {
        const double pa = luminance(power[a]), pb = luminance(power[b]);
        return pa != pb ? pa > pb : a < b;  // the same lights on every machine
    });
    double in = 0;
    for (std::ptrdiff_t k = 0; k < kept; ++k) {
        const Index i = reflecting[static_cast<Index>(k)];
        const SceneElement& e = elements.elements[i];
        VirtualPointLight light{e.centre, e.normal, {}, {}, {}, power[i]};
        setRectangle(light, elements, std::span(&i, 1));
        out.lights.push_back(light);
        in += luminance(power[i]);
    }
    out.leftOut = std::max(0.0, 1 - in / all);
    return out;
}

}  // namespace nacre
