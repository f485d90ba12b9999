#include "shading/vertex_light_pass.hpp"

#include <epoxy/gl.h>

#include <algorithm>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/pass_state.hpp"

namespace nacre {

static void attribute(GLuint index, const Buffer& buffer) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
}

GpuVertexLight::GpuVertexLight(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> weldOf)
    : indexCount_(static_cast<int>(3 * triangles.size())) {
    require(!triangles.empty(), "vertex light: mesh without triangles");
    for (const std::uint32_t w : weldOf) vertices_ = std::max<std::size_t>(vertices_, w + std::size_t{1});
    std::vector<std::uint32_t> indices;
    for (const glm::uvec3& t : triangles)
        for (int c = 0; c < 3; ++c) {
            require(t[c] < weldOf.size(), "vertex light: vertex index out of range");
            indices.push_back(weldOf[t[c]]);
        }
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STATIC_DRAW);
    attribute(0, positions_);
    attribute(1, radiance_);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    checkGl("uploading a mesh's triangles");
}

void GpuVertexLight::update(std::span<const glm::vec3> positions, std::span<const glm::vec3> radiance) {
    require(positions.size() == vertices_ && radiance.size() == vertices_,
            "vertex light: expected one position and one radiance a welded vertex");
    const auto upload = [](const Buffer& buffer, std::span<const glm::vec3> values) {
        glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size_bytes()), values.data(), GL_STREAM_DRAW);
    };
    upload(positions_, positions);
    upload(radiance_, radiance);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    filled_ = true;
    checkGl("uploading a frame's radiance");
}

void GpuVertexLight::draw() const {
    require(filled_, "vertex light: drawn before its first update");
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, indexCount_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

void renderVertexLight(ProgramLoader& loader, const RenderTarget& target, const GpuVertexLight& mesh,
                       const Camera& camera) {
    const Program& program = loader.load("vertex_light.vert.glsl", "vertex_light.frag.glsl");
    setView(program, camera, target);
    setDrawState(target);
    program.use();
    mesh.draw();
    checkGl("drawing a mesh by its vertices' radiance");
}

}  // namespace nacre
