#include "transfer/receiver_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace nacre {

namespace {

/// Position, and normal so scaled that the two count alike.
using Place = std::array<float, 6>;

struct Extent {
    Place low, high;
    explicit Extent(const Place& place) : low(place), high(place) {}
    void add(const Place& place) {
        for (std::size_t i = 0; i < place.size(); ++i)
            low[i] = std::min(low[i], place[i]), high[i] = std::max(high[i], place[i]);
    }
    float diameter() const {
        float sum = 0;
        for (std::size_t i = 0; i < low.size(); ++i) sum += (high[i] - low[i]) * (high[i] - low[i]);
        return std::sqrt(sum);
    }
};

/// The first `half` along an axis, and the others.
struct Cut {
    std::size_t axis = 0, half = 0;
};

class Cutter {
    auto before(std::size_t axis) const {
        return [this, axis](std::uint32_t x, std::uint32_t y) {
            return std::pair(places_[x][axis], x) < std::pair(places_[y][axis], y);
        };
    }

public:
    Cutter(std::vector<Place> places, std::size_t most) : places_(std::move(places)), most_(most) {}

    void cut(std::span<std::uint32_t> part, const Cut& at) const {
        std::ranges::nth_element(part, part.begin() + static_cast<std::ptrdiff_t>(at.half), before(at.axis));
    }

    /// In full groups: the kernels work by sixteen.
    Cut middle(std::span<const std::uint32_t> part) const {
        Extent extent(places_[part[0]]);
        for (const std::uint32_t v : part) extent.add(places_[v]);
        Cut out{0, (part.size() / 2 + most_ - 1) / most_ * most_};
        for (std::size_t axis = 1; axis < Place{}.size(); ++axis)
            if (extent.high[axis] - extent.low[axis] > extent.high[out.axis] - extent.low[out.axis]) out.axis = axis;
        return out;
    }

    /// Where the two sides, each as wide as it is and times the groups that it will have, are least: a part far from
    /// the others isn't torn. Of more than four groups neither side gets less than a quarter.
    Cut narrowest(std::span<const std::uint32_t> part) const {
        const std::size_t n = part.size(), least = n > 4 * most_ ? n / 4 : 1;
        Cut out = middle(part);
        float width = std::numeric_limits<float>::max();
        std::vector<std::uint32_t> sorted(part.begin(), part.end());
        for (std::size_t axis = 0; axis < Place{}.size(); ++axis) {
            std::ranges::sort(sorted, before(axis));
            const std::vector<float> first = widths(sorted);
            std::ranges::reverse(sorted);
            const std::vector<float> last = widths(sorted);
            for (std::size_t half = most_; half < n; half += most_) {
                const float both = first[half - 1] + last[n - half - 1];
                if (half < least || n - half < least || both >= width) continue;
                width = both;
                out = {axis, half};
            }
        }
        return out;
    }

private:
    /// [i] of the first i + 1: how wide, times how many groups.
    std::vector<float> widths(std::span<const std::uint32_t> sorted) const {
        std::vector<float> out;
        Extent extent(places_[sorted[0]]);
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            extent.add(places_[sorted[i]]);
            out.push_back(extent.diameter() * static_cast<float>(i / most_ + 1));
        }
        return out;
    }

    std::vector<Place> places_;
    std::size_t most_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> groupReceivers(std::span<const glm::vec3> positions,
                                                       std::span<const glm::vec3> normals, std::size_t most) {
    constexpr std::size_t kMany = 4096;  // to try all cuts of
    std::vector<std::uint32_t> all;
    glm::vec3 low(1e30f), high(-1e30f);
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (normals[v] == glm::vec3(0)) continue;
        all.push_back(v);
        low = glm::min(low, positions[v]);
        high = glm::max(high, positions[v]);
    }
    // Opposite normals part as a 32nd of the mesh's size does: what a group has in common is mostly by its extent.
    const float facing = all.empty() ? 0.0f : 0.015f * glm::length(high - low);
    std::vector<Place> places(positions.size());
    for (const std::uint32_t v : all) {
        const glm::vec3 p = positions[v], n = facing * normals[v];
        places[v] = {p.x, p.y, p.z, n.x, n.y, n.z};
    }
    const Cutter cutter(std::move(places), most);
    std::vector<std::vector<std::uint32_t>> groups;
    const std::function<void(std::span<std::uint32_t>)> halve = [&](std::span<std::uint32_t> part) {
        if (part.size() <= most) {
            if (!part.empty()) groups.emplace_back(part.begin(), part.end());
            return;
        }
        const Cut cut = part.size() > kMany ? cutter.middle(part) : cutter.narrowest(part);
        cutter.cut(part, cut);
        halve(part.first(cut.half));
        halve(part.subspan(cut.half));
    };
    halve(all);
    return groups;
}

GroupBounds boundsOfGroup(std::span<const std::uint32_t> group, std::span<const glm::vec3> positions,
                          std::span<const glm::vec3> normals) {
    GroupBounds bounds;
    glm::vec3 low(positions[group[0]]), high = low;
    for (const std::uint32_t v : group) {
        low = glm::min(low, positions[v]);
        high = glm::max(high, positions[v]);
        bounds.normal += normals[v];
    }
    bounds.centre = 0.5f * (low + high);
    bounds.normal /= static_cast<float>(group.size());
    for (const std::uint32_t v : group) {
        bounds.radius = std::max(bounds.radius, glm::distance(positions[v], bounds.centre));
        bounds.spread = std::max(bounds.spread, glm::distance(normals[v], bounds.normal));
    }
    return bounds;
}

GroupBox boxOfGroup(std::span<const std::uint32_t> group, std::span<const glm::vec3> positions) {
    glm::vec3 low(positions[group[0]]), high = low;
    for (const std::uint32_t v : group) {
        low = glm::min(low, positions[v]);
        high = glm::max(high, positions[v]);
    }
    GroupBox box{0.5f * (low + high), 0.5f * (high - low), 0};
    for (const std::uint32_t v : group) box.radius = std::max(box.radius, glm::distance(positions[v], box.middle));
    return box;
}

/// With normal n + e, |e| ≤ spread: (n + e)·(x − p) ≤ n·(c − centre) + |n|(radii) + spread (|c − centre| + radii).
bool belowHorizon(const GroupBounds& group, const glm::vec3& centre, float radius) {
    const glm::vec3 d = centre - group.centre;
    const float radii = radius + group.radius;
    return glm::dot(group.normal, d) + glm::length(group.normal) * radii + group.spread * (glm::length(d) + radii) < 0;
}

}  // namespace nacre
