// A pipe's image that is added to another's. C++: binarySwap (shading/hybrid/compositing.hpp).
#ifndef NACRE_BIND_PIPES_GLSL
#define NACRE_BIND_PIPES_GLSL

uniform sampler2D nacre_pipe_image;
uniform int nacre_pipe_row;  // of the target, where the image's lowest is

#endif
