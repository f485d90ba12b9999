// Draws that need no mesh.
#pragma once

#include "shading/gl_objects.hpp"

namespace nacre {

/// Draws one triangle over the whole viewport with the program in use; its vertex shader is `fullscreen.vert.glsl`.
/// Leaves vertex array 0 bound, and depth test, cull face and blend as they are.
/// \param empty  any vertex array without attributes (core profiles need one bound)
void drawFullscreen(const VertexArray& empty);

}  // namespace nacre
