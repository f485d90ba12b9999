#include "shading/hybrid/item_buffer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "core/error.hpp"
#include "shading/context.hpp"

namespace nacre {
namespace {

template <class T>
void upload(const Buffer& buffer, const std::vector<T>& values) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), GL_STATIC_DRAW);
}

}  // namespace

GpuElements::GpuElements(const SceneElements& elements) : vertices_(static_cast<int>(elements.corners.size())) {
    std::vector<std::uint32_t> items;
    for (std::size_t i = 0; i < elements.corners.size(); ++i) items.push_back(static_cast<std::uint32_t>(i / 3 + 1));
    glBindVertexArray(array_.name());
    upload(positions_, elements.corners);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    upload(items_, items);
    glEnableVertexAttribArray(1);
    glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, sizeof(std::uint32_t), nullptr);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    checkGl("uploading elements");
}

void GpuElements::draw() const {
    glBindVertexArray(array_.name());
    glDrawArrays(GL_TRIANGLES, 0, vertices_);
    glBindVertexArray(0);
}

ItemBuffer::ItemBuffer(int size) : size_(size) {
    require(size >= 1, "item buffer: expected a size >= 1");
    const auto attach = [&](const Renderbuffer& buffer, GLenum attachment, GLenum format) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
        glRenderbufferStorage(GL_RENDERBUFFER, format, size, size);
        glBindRenderbuffer(GL_RENDERBUFFER, 0);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer.name());
    };
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    attach(items_, GL_COLOR_ATTACHMENT0, GL_R32UI);
    attach(depth_, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("making an item buffer");
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("item buffer of {0} x {0}: expected a complete framebuffer, found status 0x{1:04x}",
                                size, status));
}

std::vector<std::uint32_t> ItemBuffer::draw(ProgramLoader& loader, const GpuElements& elements,
                                            const glm::dmat4& worldToClip) {
    const Program& program = loader.load("item_buffer.vert.glsl", "item_buffer.frag.glsl");
    program.set("nacre_item_to_clip", glm::mat4(worldToClip));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, size_, size_);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    const GLuint none[4] = {0, 0, 0, 0};
    const GLfloat far = 1;
    glClearBufferuiv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &far);
    elements.draw();
    std::vector<std::uint32_t> out(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size_, size_, GL_RED_INTEGER, GL_UNSIGNED_INT, out.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("drawing an item buffer");
    return out;
}

}  // namespace nacre
