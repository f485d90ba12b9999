#include "shading/draw.hpp"

#include <epoxy/gl.h>

namespace nacre {

void drawFullscreen(const VertexArray& empty) {
    glBindVertexArray(empty.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

}  // namespace nacre
