#include "core/volume.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"

namespace nacre {
namespace {

Vec3 edges(const Volume& volume) { return Vec3(volume.size) * volume.spacing; }

/// The eight samples about a point, and how far it is between them.
struct Cell {
    std::array<std::size_t, 8> index;
    Vec3 part;
};

Cell cellAt(const Volume& volume, const Vec3& at) {
    glm::ivec3 low, high;
    Cell cell;
    for (int c = 0; c < 3; ++c) {
        const double p = std::clamp(at[c] * volume.size[c] - 0.5, 0.0, volume.size[c] - 1.0);
        low[c] = static_cast<int>(p);
        high[c] = std::min(low[c] + 1, volume.size[c] - 1);
        cell.part[c] = p - low[c];
    }
    for (std::size_t i = 0; i < 8; ++i) {
        const auto x = static_cast<std::size_t>(i & 1 ? high.x : low.x),
                   y = static_cast<std::size_t>(i & 2 ? high.y : low.y),
                   z = static_cast<std::size_t>(i & 4 ? high.z : low.z);
        cell.index[i] = (z * static_cast<std::size_t>(volume.size.y) + y) * static_cast<std::size_t>(volume.size.x) + x;
    }
    return cell;
}

double weight(const Cell& cell, std::size_t corner) {
    return (corner & 1 ? cell.part.x : 1 - cell.part.x) * (corner & 2 ? cell.part.y : 1 - cell.part.y) *
           (corner & 4 ? cell.part.z : 1 - cell.part.z);
}

}  // namespace

void checkVolume(const Volume& volume) {
    std::size_t count = 1;
    for (int c = 0; c < 3; ++c) {
        require(volume.size[c] >= 1, "volume: a size is below 1");
        require(std::isfinite(volume.spacing[c]) && volume.spacing[c] > 0, "volume: a spacing must be finite, > 0");
        count *= static_cast<std::size_t>(volume.size[c]);
    }
    require(volume.values.size() == count,
            fmt::format("volume: expected {} values, found {}", count, volume.values.size()));
    for (const float v : volume.values) require(std::isfinite(v), "volume: a value is not finite");
}

glm::dmat4 volumeToLocal(const Volume& volume) {
    const Vec3 extent = edges(volume) * (2 / maxComponent(edges(volume)));
    return glm::scale(glm::dmat4(1), extent) * glm::translate(glm::dmat4(1), Vec3(-0.5));
}

double sampleVolume(const Volume& volume, const Vec3& at) {
    const Cell cell = cellAt(volume, at);
    double sum = 0;
    for (std::size_t i = 0; i < 8; ++i) sum += weight(cell, i) * volume.values[cell.index[i]];
    return sum;
}

std::vector<glm::vec3> volumeGradients(const Volume& volume) {
    const Vec3 texel = volume.spacing * (2 / maxComponent(edges(volume)));
    std::vector<glm::vec3> out;
    out.reserve(volume.values.size());
    glm::ivec3 at;
    for (at.z = 0; at.z < volume.size.z; ++at.z)
        for (at.y = 0; at.y < volume.size.y; ++at.y)
            for (at.x = 0; at.x < volume.size.x; ++at.x) {
                glm::vec3 gradient(0);
                for (int c = 0; c < 3; ++c) {
                    glm::ivec3 before = at, after = at;
                    before[c] = std::max(at[c] - 1, 0);
                    after[c] = std::min(at[c] + 1, volume.size[c] - 1);
                    if (after[c] == before[c]) continue;
                    const double rise = static_cast<double>(volume.at(after.x, after.y, after.z)) -
                                        volume.at(before.x, before.y, before.z);
                    gradient[c] = static_cast<float>(rise / ((after[c] - before[c]) * texel[c]));
                }
                out.push_back(gradient);
            }
    return out;
}

Vec3 sampleGradients(const Volume& volume, const std::vector<glm::vec3>& gradients, const Vec3& at) {
    const Cell cell = cellAt(volume, at);
    Vec3 sum(0);
    for (std::size_t i = 0; i < 8; ++i) sum += weight(cell, i) * Vec3(gradients[cell.index[i]]);
    return sum;
}

}  // namespace nacre
