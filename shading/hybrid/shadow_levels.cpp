#include "shading/hybrid/shadow_levels.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {

LevelTarget::LevelTarget(int width, int height, GlName depth) {
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, width, height, 0, GL_RED, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
    if (depth != 0) glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("making a target of shadow levels");
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("shadow levels: expected a complete framebuffer, found status 0x{:04x}", status));
}

ShadowLevels::ShadowLevels(int width, int height)
    : width_(width), height_(height), sum_(width, height), filtered_(width, height) {}

void ShadowLevels::clear() {
    const GLfloat zero[] = {0, 0, 0, 0};
    glBindFramebuffer(GL_FRAMEBUFFER, sum_.framebuffer());
    glClearBufferfv(GL_COLOR, 0, zero);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    step_ = 0;
}

void ShadowLevels::beginAdding(double weight) {
    step_ = std::max(step_, weight);
    glBindFramebuffer(GL_FRAMEBUFFER, sum_.framebuffer());
    glViewport(0, 0, width_, height_);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
}

void ShadowLevels::endAdding() {
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void ShadowLevels::filter(ProgramLoader& loader, const GeometryBuffer& geometry, ShadowFilter filter,
                          GlName framebuffer) const {
    const Program& program = loader.load("fullscreen.vert.glsl", "shadow_filter.frag.glsl",
                                         {{"NACRE_FILTER_RADIUS", filter == ShadowFilter::None ? "0" : "3"},
                                          {"NACRE_EDGE_STOPPING", filter == ShadowFilter::EdgeStopping ? "1" : "0"}});
    geometry.bind(program);
    glActiveTexture(GL_TEXTURE3);
    glBindTexture(GL_TEXTURE_2D, sum_.texture());
    program.set("nacre_counted_image", 3);
    program.set("nacre_counted_value", static_cast<float>(step_));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glViewport(0, 0, width_, height_);
    drawFullscreen(VertexArray());
    glEnable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Image ShadowLevels::read(ProgramLoader& loader, const GeometryBuffer& geometry, ShadowFilter kind) {
    filter(loader, geometry, kind, filtered_.framebuffer());
    std::vector<float> values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    glBindFramebuffer(GL_FRAMEBUFFER, filtered_.framebuffer());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RED, GL_FLOAT, values.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    checkGl("reading shadow levels");
    Image out(width_, height_, 1);
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
            out.at(x, height_ - 1 - y, 0) =
                values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    return out;
}

}  // namespace nacre
