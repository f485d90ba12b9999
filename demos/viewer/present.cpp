#include "demos/viewer/present.hpp"

#include <epoxy/gl.h>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"

namespace nacre {

void Presenter::allocate(int width, int height) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    if (width == width_ && height == height_) return;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    width_ = width;
    height_ = height;
}

void Presenter::take(const RenderTarget& target) {
    allocate(target.width(), target.height());
    target.bindForReading();
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, width_, height_);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    topDown_ = false;
    checkGl("copying a picture");
}

void Presenter::take(const Image& image) {
    require(image.channels() == 3, "Presenter: expected RGB");
    allocate(image.width(), image.height());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_FLOAT, image.data().data());
    glBindTexture(GL_TEXTURE_2D, 0);
    topDown_ = true;
    checkGl("uploading a picture");
}

void Presenter::show(ProgramLoader& loader, const WindowArea& area, double white) const {
    const Program& program = loader.load("fullscreen.vert.glsl", "present.frag.glsl");
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(area.x, area.y, area.width, area.height);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    program.set("nacre_present_picture", 0);
    program.set("nacre_present_white", static_cast<float>(white));
    // Window pixels to the picture's texture coordinates.
    const glm::vec2 origin(area.x, area.y), scale = 1.0f / glm::vec2(area.width, area.height);
    glm::vec4 place(-origin * scale, scale);
    if (topDown_) place = glm::vec4(place.x, 1 - place.y, place.z, -place.w);
    program.set("nacre_present_area", place);
    program.use();
    drawFullscreen(empty_);
    glBindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace nacre
