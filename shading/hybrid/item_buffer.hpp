// Which element each pixel of a view shows (Weghorst, Hooper and Greenberg's item buffer, HYBRID sections 3 and 4).
#pragma once

#include <cstdint>
#include <vector>

#include "shading/gl_objects.hpp"
#include "shading/hybrid/scene_elements.hpp"
#include "shading/program.hpp"

namespace nacre {

/// Elements' triangles on the GPU. Attributes 0 position, 1 the element's number, from 1 on.
class GpuElements {
public:
    /// Leaves vertex array 0 and array buffer 0 bound.
    explicit GpuElements(const SceneElements& elements);
    /// With the program in use. Leaves vertex array 0 bound.
    void draw() const;

private:
    VertexArray array_;
    Buffer positions_, items_;
    int vertices_ = 0;
};

/// size × size pixels of 32 bits, and depth.
class ItemBuffer {
public:
    /// \throws std::invalid_argument unless size ≥ 1; nacre::Error from the driver
    explicit ItemBuffer(int size);
    int size() const { return size_; }
    /// Numbers of the elements that are seen, both sides of them, row 0 lowest; 0 where nothing is. Leaves framebuffer
    /// 0 bound, depth test and write on, culling and blending off.
    std::vector<std::uint32_t> draw(ProgramLoader& loader, const GpuElements& elements, const glm::dmat4& worldToClip);

private:
    int size_;
    FramebufferName framebuffer_;
    Renderbuffer items_, depth_;
};

}  // namespace nacre
