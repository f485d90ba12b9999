#include "shading/hybrid/virtual_shadows.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "core/error.hpp"
#include "shading/context.hpp"

namespace nacre {

Mat3 virtualLightFrame(const Vec3& n) {
    const double s = n.z < 0 ? -1 : 1, a = -1 / (s + n.z), b = n.x * n.y * a;
    return Mat3(Vec3(1 + s * n.x * n.x * a, s * b, -s * n.x), Vec3(b, s + n.y * n.y * a, -n.y), n);
}

VirtualShadows::VirtualShadows(int size) : size_(size) { require(size >= 8, "virtual shadows: expected a size >= 8"); }

void VirtualShadows::draw(ProgramLoader& loader, const GpuElements& gpu, const Bounds& bounds,
                          std::span<const VirtualPointLight> lights) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
    if (layers_ != lights.size()) {
        glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, size_, size_, static_cast<GLsizei>(lights.size()),
                     0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
        glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
        layers_ = lights.size();
    }
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
    const double size = glm::length(bounds.high - bounds.low);
    lift_ = 1e-3 * size;
    drawn_ = glm::vec4(Vec4(0, 1 / (1.01 * size), 1 - 2.0 / size_, size_));  // a texel beyond the horizon
    const Program& program =
        loader.load("shadow_map.vert.glsl", "shadow_map.frag.glsl", {{"NACRE_SHADOW_PARABOLOID", "1"}});
    program.set("nacre_shadow_drawn", drawn_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const GLenum none = GL_NONE;
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    glViewport(0, 0, size_, size_);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, texture_.name(), 0, static_cast<GLint>(i));
        glClear(GL_DEPTH_BUFFER_BIT);
        const Mat3 toLight = glm::transpose(virtualLightFrame(lights[i].normal));
        glm::dmat4 fromWorld(toLight);
        fromWorld[3] = Vec4(-(toLight * (lights[i].position + lift_ * lights[i].normal)), 1);
        program.set("nacre_shadow_from_mesh", glm::mat4(fromWorld));
        gpu.draw();
    }
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("drawing shadow maps of virtual lights");
    if (!lights.empty() && status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("virtual shadows: expected a complete framebuffer, found status 0x{:04x}", status));
}

void VirtualShadows::bind(const Program& program, int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
    program.set("nacre_virtual_maps", unit);
    program.set("nacre_virtual_drawn", drawn_);
}

}  // namespace nacre
