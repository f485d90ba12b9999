#include "shading/hybrid/mapped_shadows.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {

/// A face of the cubes around all points, and what of the casters it may see. Twin: nacre_point_face.
struct MappedShadows::Face {
    int axis = 0;
    double sign = 1;
    std::vector<glm::uvec3> triangles;

    int column() const { return 2 * axis + (sign < 0 ? 1 : 0); }
    /// Rows: right, up, ahead.
    Mat3 frame() const {
        Mat3 out(0);
        out[(axis + 1) % 3].x = out[(axis + 2) % 3].y = 1;
        out[axis].z = sign;
        return out;
    }
    /// Unit vectors n of the four sides: what the face sees from p has n · (x − p) ≥ 0.
    std::array<Vec3, 4> sides() const {
        const Mat3 axes = glm::transpose(frame());
        const double half = std::sqrt(0.5);
        return {half * (axes[2] + axes[0]), half * (axes[2] - axes[0]), half * (axes[2] + axes[1]),
                half * (axes[2] - axes[1])};
    }
};

namespace {

/// Depths in [0, 1] of the maps: A − B / distance along the face's axis.
struct DepthRange {
    double near, far;
    double a() const { return far / (far - near); }
    double b() const { return far * near / (far - near); }
};

/// Least of n · p of the points, for which something is seen from one of them with n · x at least that.
double leastAlong(const Vec3& n, std::span<const Light> points) {
    double least = std::numeric_limits<double>::infinity();
    for (const Light& p : points) least = std::min(least, glm::dot(n, p.position));
    return least;
}

/// What a camera sees of a box about the scene: eight corners.
std::array<Vec3, 8> seenCorners(const Camera& camera, double aspect) {
    const glm::dmat4 toWorld = glm::inverse(camera.projection(aspect) * camera.view());
    std::array<Vec3, 8> out;
    for (int i = 0; i < 8; ++i) {
        const Vec4 p = toWorld * Vec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1, 1);
        out[static_cast<std::size_t>(i)] = Vec3(p) / p.w;
    }
    return out;
}

void appendCaster(std::vector<glm::vec3>& positions, std::vector<glm::uvec3>& triangles, const Mesh& mesh,
                  const glm::dmat4& toWorld) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const glm::vec3& p : mesh.positions) positions.emplace_back(toWorld * Vec4(p, 1));
    for (const glm::uvec3& t : mesh.triangles) triangles.push_back(t + first);
}

}  // namespace

MappedShadows::MappedShadows(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.mesh >= 0 && node.castsShadow)
            appendCaster(positions_, triangles_, scene.meshes[static_cast<std::size_t>(node.mesh)].mesh, nodes.at(i));
    }
    for (const glm::vec3& p : positions_) bounds_.add(p);
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, points_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(positions_.size() * sizeof(glm::vec3)), positions_.data(),
                 GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

/// Those that a pixel's surface may lie in, as seen from one of the points.
std::vector<MappedShadows::Face> MappedShadows::facesOf(std::span<const Light> points, const Camera& camera,
                                                        double aspect) const {
    const std::array<Vec3, 8> seen = seenCorners(camera, aspect);
    std::vector<Face> out;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            Face face{axis, sign, {}};
            const std::array<Vec3, 4> sides = face.sides();
            std::array<double, 4> least{};
            for (std::size_t k = 0; k < 4; ++k) least[k] = leastAlong(sides[k], points);
            const auto outside = [&](const auto& corners) {
                for (std::size_t k = 0; k < 4; ++k)
                    if (std::all_of(corners.begin(), corners.end(),
                                    [&](const Vec3& p) { return glm::dot(sides[k], p) < least[k]; }))
                        return true;
                return false;
            };
            if (outside(seen)) continue;
            for (const glm::uvec3& t : triangles_)
                if (!outside(std::array<Vec3, 3>{positions_[t.x], positions_[t.y], positions_[t.z]}))
                    face.triangles.push_back(t);
            out.push_back(std::move(face));
        }
    return out;
}

void MappedShadows::allocate(int width, int height) {
    if (maps_ && width_ == width && height_ == height) return;
    maps_.emplace();
    width_ = width, height_ = height;
    glBindTexture(GL_TEXTURE_2D, maps_->name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const GLenum none = GL_NONE;
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, maps_->name(), 0);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("making maps of a light's points");
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("mapped shadows: expected a complete framebuffer, found status 0x{:04x}", status));
}

void MappedShadows::add(ProgramLoader& loader, const GeometryBuffer& geometry, const Camera& camera,
                        std::span<const Light> points, ShadowLevels& levels, const MappedShadowOptions& options) {
    require(!points.empty() && points.size() <= kMostPoints,
            fmt::format("mapped shadows: expected 1 to {} points, found {}", kMostPoints, points.size()));
    require(std::none_of(points.begin(), points.end(), [](const Light& p) { return p.directional; }),
            "mapped shadows: expected points, found a direction");
    require(options.size >= 8 && options.size <= 1024, "mapped shadows: expected a size from 8 to 1024");
    require(levels.width() == geometry.width() && levels.height() == geometry.height(),
            "mapped shadows: expected levels of the geometry's size");
    const double aspect = double(geometry.width()) / geometry.height();
    const std::vector<Face> faces = facesOf(points, camera, aspect);
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    const int size = std::min({options.size, most / static_cast<int>(points.size()), most / 6});
    allocate(6 * size, static_cast<int>(points.size()) * size);

    // Far: from one of the points to the end of the scene.
    Bounds reach = bounds_;
    for (const Light& p : points) reach.add(p.position);
    const double extent = triangles_.empty() ? 1 : glm::length(reach.high - reach.low);
    const DepthRange depth{1e-3 * extent, 1.01 * extent};

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, width_, height_);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glClear(GL_DEPTH_BUFFER_BIT);
    const Program& map = loader.load("point_map.vert.glsl", "point_map.frag.glsl");
    glBindVertexArray(array_.name());
    drawn_ = 0;
    for (const Face& face : faces) {
        if (face.triangles.empty()) continue;
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(face.triangles.size() * sizeof(glm::uvec3)),
                     face.triangles.data(), GL_STREAM_DRAW);
        const Mat3 frame = face.frame();
        for (std::size_t i = 0; i < points.size(); ++i) {
            glm::dmat4 toFace(frame);
            toFace[3] = Vec4(-(frame * points[i].position), 1);
            glm::dmat4 clip(1);
            clip[2] = Vec4(0, 0, 2 * depth.a() - 1, 1);
            clip[3] = Vec4(0, 0, -2 * depth.b(), 0);
            map.set("nacre_point_to_clip", glm::mat4(clip * toFace));
            glViewport(face.column() * size, static_cast<int>(i) * size, size, size);
            map.use();
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * face.triangles.size()), GL_UNSIGNED_INT, nullptr);
            drawn_ += face.triangles.size();
        }
    }
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);

    const Program& look = loader.load("fullscreen.vert.glsl", "mapped_shadow.frag.glsl",
                                      {{"NACRE_POINTS", std::to_string(points.size())}});
    std::vector<glm::vec4> places;
    for (const Light& p : points) places.emplace_back(glm::vec3(p.position), 0.0f);
    geometry.bind(look);
    glActiveTexture(GL_TEXTURE3);
    glBindTexture(GL_TEXTURE_2D, maps_->name());
    look.set("nacre_point_maps", 3);
    look.set("nacre_point_places", std::span<const glm::vec4>(places));
    look.set("nacre_point_depth", glm::vec4(Vec4(depth.a(), depth.b(), depth.near, 2 * options.offset / size)));
    look.set("nacre_point_size", size);
    levels.beginAdding(1.0 / static_cast<double>(points.size()));
    drawFullscreen(VertexArray());
    levels.endAdding();
    checkGl("looking up maps of a light's points");
}

}  // namespace nacre
