// A mesh in GPU buffers.
#pragma once

#include "core/scene.hpp"
#include "shading/gl_objects.hpp"

namespace nacre {

/// Attributes 0 position, 1 normal, 2 tangent (xyz, w), 3 uv.
class GpuMesh {
public:
    /// Leaves vertex array 0 and array buffer 0 bound.
    /// \throws std::invalid_argument when the mesh has no triangles, an index out of range, or too few normals,
    ///         tangents or uvs
    explicit GpuMesh(const Mesh& mesh);

    int indexCount() const { return indexCount_; }
    /// Draws every triangle with the program in use. Leaves vertex array 0 bound.
    /// \param radiance  three floats a vertex for attribute 4, or none
    void draw(const Buffer* radiance = nullptr) const;

private:
    VertexArray array_;
    Buffer vertices_, indices_;
    int indexCount_ = 0;
};

}  // namespace nacre
