#include "shading/volume_surface.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "shading/gl_objects.hpp"

namespace nacre {
namespace {

constexpr double kMostSteps = 4096;

Vec3 corner(const glm::dmat4& toWorld, int i) { return toWorld * Vec4(i & 1, (i >> 1) & 1, (i >> 2) & 1, 1); }

/// Least and greatest of dot(axis, ·) over the box.
Vec2 extentAlong(const glm::dmat4& toWorld, const Vec3& axis) {
    Vec2 out(std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest());
    for (int i = 0; i < 8; ++i) {
        const double d = glm::dot(axis, corner(toWorld, i));
        out = {std::min(out.x, d), std::max(out.y, d)};
    }
    return out;
}

/// Where the plane dot(axis, ·) = depth cuts the box's edges, going round. At most six points.
std::vector<Vec3> cut(const glm::dmat4& toWorld, const Vec3& axis, double depth) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i)
        for (int bit = 1; bit < 8; bit *= 2) {
            if (i & bit) continue;
            const Vec3 a = corner(toWorld, i), b = corner(toWorld, i | bit);
            const double da = glm::dot(axis, a) - depth, db = glm::dot(axis, b) - depth;
            if ((da < 0) != (db < 0)) points.push_back(glm::mix(a, b, da / (da - db)));
        }
    if (points.size() < 3) return {};
    Vec3 centre(0);
    for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
    const Vec3 x = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const Vec3 y = glm::cross(axis, x);
    const auto angle = [&](const Vec3& p) { return std::atan2(glm::dot(p - centre, y), glm::dot(p - centre, x)); };
    std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
    return points;
}

/// Shortest edge of a texel in the world.
double texelEdge(const VolumeSurface& surface) {
    const glm::dmat4 box = volumeBox(surface);
    double shortest = std::numeric_limits<double>::max();
    for (int c = 0; c < 3; ++c) shortest = std::min(shortest, glm::length(Vec3(box[c])) / surface.volume->size()[c]);
    return shortest;
}

}  // namespace

glm::dmat4 volumeBox(const VolumeSurface& surface) { return surface.toWorld * surface.volume->toLocal(); }

double volumeStep(const VolumeSurface& surface) { return surface.step * texelEdge(surface); }

void checkVolume(const VolumeSurface& surface) {
    require(surface.volume != nullptr, "volume: no volume");
    require(std::isfinite(surface.iso), "volume: iso must be finite");
    require(std::isfinite(surface.step) && surface.step > 0, "volume: step must be finite, > 0");
    const glm::dmat4 box = volumeBox(surface);
    const double diagonal = glm::length(corner(box, 7) - corner(box, 0));
    const double steps = diagonal / (volumeStep(surface));
    require(steps <= kMostSteps, fmt::format("volume: at most {} steps across the volume, found {:.0f}; a longer "
                                             "step is needed",
                                             kMostSteps, steps));
}

void bindVolume(const Program& program, const VolumeSurface& surface, int unit, const glm::dmat4& toSpace) {
    surface.volume->bind(unit);
    program.set("nacre_volume", unit);
    program.set("nacre_volume_iso", static_cast<float>(surface.iso / surface.volume->valueScale()));
    program.set("nacre_volume_step", static_cast<float>(volumeStep(surface)));
    program.set("nacre_volume_from_world", glm::mat4(glm::inverse(toSpace * volumeBox(surface))));
    const glm::dmat3 normals(toSpace * surface.toWorld);
    program.set("nacre_volume_normal", glm::mat3(glm::transpose(glm::inverse(normals))));
}

std::vector<glm::vec3> volumeSlices(const glm::dmat4& toWorld, const Vec3& axis, double step) {
    const Vec2 extent = extentAlong(toWorld, axis);
    std::vector<glm::vec3> out;
    for (int i = 0;; ++i) {
        const double depth = extent.x + (i + 0.5) * step;
        if (!(depth < extent.y)) return out;
        const std::vector<Vec3> points = cut(toWorld, axis, depth);
        for (std::size_t k = 2; k < points.size(); ++k)
            for (const std::size_t p : {std::size_t{0}, k - 1, k}) out.push_back(glm::vec3(points[p]));
    }
}

void drawSlices(const std::vector<glm::vec3>& triangles) {
    const VertexArray array;
    const Buffer buffer;
    glBindVertexArray(array.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(glm::vec3)), triangles.data(),
                 GL_STREAM_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(triangles.size()));
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindVertexArray(0);
}

}  // namespace nacre
