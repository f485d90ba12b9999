#include "shading/hybrid/geometry_buffer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/pass_state.hpp"

namespace nacre {

GeometryBuffer::GeometryBuffer(int width, int height) : width_(width), height_(height) {
    require(width >= 1 && height >= 1, "geometry buffer: expected sizes >= 1");
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    GLenum attachment = GL_COLOR_ATTACHMENT0;
    for (const TextureName* texture : {&place_, &normal_, &albedo_}) {
        glBindTexture(GL_TEXTURE_2D, texture->name());
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment++, GL_TEXTURE_2D, texture->name(), 0);
    }
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);  // as RenderTarget: the same points win
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
    const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
    glDrawBuffers(3, buffers);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("making a geometry buffer");
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("geometry buffer of {} x {}: expected a complete framebuffer, found status 0x{:04x}",
                                width, height, status));
}

void GeometryBuffer::draw(ProgramLoader& loader, const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                          std::span<const Rgb> albedos, std::map<int, GpuMesh>& meshes, const Camera& camera) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, width_, height_);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const Program& program = loader.load("lit.vert.glsl", "geometry.frag.glsl");
    setView(program, camera, double(width_) / height_);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.mesh < 0) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)].mesh;
        if (mesh.triangles.empty()) continue;
        const auto material = static_cast<std::size_t>(node.material);
        program.set("nacre_geometry_surface", glm::vec4(glm::vec3(albedos[material]), static_cast<float>(i + 1)));
        program.set("nacre_geometry_specular", scene.materials[material].specular ? 1.0f : 0.0f);
        drawPlaced(program, meshes.try_emplace(node.mesh, mesh).first->second, nodes[i]);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("drawing a geometry buffer");
}

std::vector<SeenPoint> GeometryBuffer::read() const {
    const auto count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    std::vector<glm::vec4> place(count), normal(count);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, place.data());
    glReadBuffer(GL_COLOR_ATTACHMENT1);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, normal.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("reading a geometry buffer");
    std::vector<SeenPoint> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) out.push_back({place[i], normal[i]});
    return out;
}

void GeometryBuffer::bind(const Program& program) const {
    int unit = 0;
    for (const TextureName* texture : {&place_, &normal_, &albedo_}) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit++));
        glBindTexture(GL_TEXTURE_2D, texture->name());
    }
    program.set("nacre_geometry_place", 0);
    program.set("nacre_geometry_normal", 1);
    program.set("nacre_geometry_albedo", 2);
}

}  // namespace nacre
