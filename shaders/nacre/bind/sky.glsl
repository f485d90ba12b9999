// The surrounding behind everything. C++: renderSky (shading/environment_pass.cpp).
#ifndef NACRE_BIND_SKY_GLSL
#define NACRE_BIND_SKY_GLSL

uniform mat4 nacre_clip_to_world;

#endif
