// One move-only handle per OpenGL object: created in the constructor, deleted in the destructor, moved-from is 0.
// A context must be current for both. These headers name no GL type, so that users may bring their own loader.
#pragma once

#include <utility>

namespace nacre {

using GlName = unsigned int;

template <GlName (*Create)(), void (*Destroy)(GlName)>
class GlObject {
public:
    /// \throws nacre::Error when the driver returns no name
    GlObject() : name_(Create()) {}
    ~GlObject() {
        if (name_ != 0) Destroy(name_);
    }
    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0u)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;
    GlName name() const { return name_; }

private:
    GlName name_ = 0;
};

namespace gl {
GlName createTexture();
void destroyTexture(GlName name);
GlName createBuffer();
void destroyBuffer(GlName name);
GlName createVertexArray();
void destroyVertexArray(GlName name);
GlName createFramebuffer();
void destroyFramebuffer(GlName name);
GlName createRenderbuffer();
void destroyRenderbuffer(GlName name);
GlName createQuery();
void destroyQuery(GlName name);
GlName createProgram();
void destroyProgram(GlName name);
}  // namespace gl

using TextureName = GlObject<gl::createTexture, gl::destroyTexture>;
using Buffer = GlObject<gl::createBuffer, gl::destroyBuffer>;
using VertexArray = GlObject<gl::createVertexArray, gl::destroyVertexArray>;
using FramebufferName = GlObject<gl::createFramebuffer, gl::destroyFramebuffer>;
using Renderbuffer = GlObject<gl::createRenderbuffer, gl::destroyRenderbuffer>;
using Query = GlObject<gl::createQuery, gl::destroyQuery>;
using ProgramName = GlObject<gl::createProgram, gl::destroyProgram>;

}  // namespace nacre
