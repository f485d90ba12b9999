#include "shading/gpu_mesh.hpp"

#include <epoxy/gl.h>

#include <cstddef>

#include "core/error.hpp"
#include "shading/context.hpp"

namespace nacre {
namespace {

struct Vertex {
    glm::vec3 position, normal;
    glm::vec4 tangent;
    glm::vec2 uv;
};

std::vector<Vertex> interleave(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    require(mesh.normals.size() == count && mesh.tangents.size() == count && mesh.uvs.size() == count,
            "GpuMesh: needs a normal, a tangent and a uv for each position");
    std::vector<Vertex> out(count);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = {mesh.positions[i], mesh.normals[i], mesh.tangents[i], mesh.uvs[i]};
    return out;
}

void attribute(GLuint index, GLint size, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(offset));
}

}  // namespace

GpuMesh::GpuMesh(const Mesh& mesh) : indexCount_(static_cast<int>(mesh.triangles.size() * 3)) {
    require(!mesh.triangles.empty(), "GpuMesh: mesh without triangles");
    const std::vector<Vertex> vertices = interleave(mesh);
    for (const glm::uvec3& t : mesh.triangles)
        require(t.x < vertices.size() && t.y < vertices.size() && t.z < vertices.size(),
                "GpuMesh: vertex index out of range");
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                 GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(glm::uvec3)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    attribute(0, 3, offsetof(Vertex, position));
    attribute(1, 3, offsetof(Vertex, normal));
    attribute(2, 4, offsetof(Vertex, tangent));
    attribute(3, 2, offsetof(Vertex, uv));
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    checkGl("uploading a mesh");
}

void GpuMesh::draw(const Buffer* radiance) const {
    glBindVertexArray(array_.name());
    if (radiance != nullptr) {
        glBindBuffer(GL_ARRAY_BUFFER, radiance->name());
        glVertexAttribPointer(4, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
        glEnableVertexAttribArray(4);
    }
    glDrawElements(GL_TRIANGLES, indexCount_, GL_UNSIGNED_INT, nullptr);
    if (radiance != nullptr) {
        glDisableVertexAttribArray(4);
        glBindBuffer(GL_ARRAY_BUFFER, 0);
    }
    glBindVertexArray(0);
}

}  // namespace nacre
