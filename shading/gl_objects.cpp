#include "shading/gl_objects.hpp"

#include <epoxy/gl.h>

#include "core/error.hpp"

namespace nacre::gl {
namespace {

GLuint checked(GLuint name, const char* what) {
    if (name == 0) throw Error(std::string("OpenGL gave no name for a ") + what);
    return name;
}

}  // namespace

GlName createTexture() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return checked(name, "texture");
}
void destroyTexture(GlName name) { glDeleteTextures(1, &name); }

GlName createBuffer() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return checked(name, "buffer");
}
void destroyBuffer(GlName name) { glDeleteBuffers(1, &name); }

GlName createVertexArray() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return checked(name, "vertex array");
}
void destroyVertexArray(GlName name) { glDeleteVertexArrays(1, &name); }

GlName createFramebuffer() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return checked(name, "framebuffer");
}
void destroyFramebuffer(GlName name) { glDeleteFramebuffers(1, &name); }

GlName createRenderbuffer() {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    return checked(name, "renderbuffer");
}
void destroyRenderbuffer(GlName name) { glDeleteRenderbuffers(1, &name); }

GlName createQuery() {
    GLuint name = 0;
    glGenQueries(1, &name);
    return checked(name, "query");
}
void destroyQuery(GlName name) { glDeleteQueries(1, &name); }

GlName createProgram() { return checked(glCreateProgram(), "program"); }
void destroyProgram(GlName name) { glDeleteProgram(name); }

}  // namespace nacre::gl
