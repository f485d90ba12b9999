#include "shading/volume_pass.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

/// After a BRDF's textures, where a mesh's relief is else.
constexpr int kVolumeUnit = kMaxFactoredTextures;
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

glm::dmat4 boxToWorld(const VolumeSurface& surface) { return surface.toWorld * surface.volume->toLocal(); }

/// Shortest edge of a texel in the world.
double texelEdge(const VolumeSurface& surface) {
    const glm::dmat4 box = boxToWorld(surface);
    double shortest = std::numeric_limits<double>::max();
    for (int c = 0; c < 3; ++c) shortest = std::min(shortest, glm::length(Vec3(box[c])) / surface.volume->size()[c]);
    return shortest;
}

void check(const VolumeSurface& surface) {
    require(surface.volume != nullptr, "renderVolume: no volume");
    require(std::isfinite(surface.iso), "renderVolume: iso must be finite");
    require(std::isfinite(surface.step) && surface.step > 0, "renderVolume: step must be finite, > 0");
    const glm::dmat4 box = boxToWorld(surface);
    const double diagonal = glm::length(corner(box, 7) - corner(box, 0));
    const double steps = diagonal / (surface.step * texelEdge(surface));
    require(steps <= kMostSteps, fmt::format("renderVolume: at most {} steps across the volume, found {:.0f}; a longer "
                                             "step is needed",
                                             kMostSteps, steps));
}

void setVolume(const Program& program, const VolumeSurface& surface, double step) {
    surface.volume->bind(kVolumeUnit);
    program.set("nacre_volume", kVolumeUnit);
    program.set("nacre_volume_iso", static_cast<float>(surface.iso / surface.volume->valueScale()));
    program.set("nacre_volume_step", static_cast<float>(step));
    program.set("nacre_volume_from_world", glm::mat4(glm::inverse(boxToWorld(surface))));
    program.set("nacre_volume_normal", glm::mat3(glm::transpose(glm::inverse(glm::dmat3(surface.toWorld)))));
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

/// Depth test and write on, culling and blending off; left so.
void setState(const RenderTarget& target) {
    target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

template <class Brdf>
void render(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
            const Brdf& brdf) {
    check(surface);
    checkLights(view.lights, kMaxLights);
    const bool march = surface.method == VolumeMethod::March;
    ShaderDefines defines = withLights(brdf.defines(), view.lights);
    if (march) defines.emplace_back("NACRE_VOLUME_MARCH", "1");
    const Program& program = loader.load("volume.vert.glsl", "volume.frag.glsl", defines);
    brdf.bind(program);
    const double step = surface.step * texelEdge(surface);
    setVolume(program, surface, step);
    setView(program, view.camera, target);
    setLights(program, view);
    const double aspect = static_cast<double>(target.width()) / target.height();
    if (march)
        program.set("nacre_clip_to_world",
                    glm::mat4(glm::inverse(view.camera.projection(aspect) * view.camera.view())));
    setState(target);
    program.use();
    if (march)
        drawFullscreen(VertexArray());
    else
        drawSlices(volumeSlices(boxToWorld(surface), glm::normalize(view.camera.target - view.camera.eye), step));
    checkGl("drawing a volume");
}

}  // namespace

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

void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuFactoredBrdf& brdf) {
    render(loader, target, surface, view, brdf);
}

void renderVolume(ProgramLoader& loader, const RenderTarget& target, const VolumeSurface& surface, const LitView& view,
                  const GpuDirectBrdf& brdf) {
    render(loader, target, surface, view, brdf);
}

}  // namespace nacre
