// Where the picture is taken from. C++: drawLit (shading/lit_pass.cpp).
#ifndef NACRE_BIND_VIEW_GLSL
#define NACRE_BIND_VIEW_GLSL

uniform mat4 nacre_world_to_clip;
uniform vec4 nacre_eye;  // w = 1: position of the eye; w = 0: unit direction towards an orthographic viewer

#endif
