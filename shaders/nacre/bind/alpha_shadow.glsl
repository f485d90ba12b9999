// Shadow maps by the alpha test. C++: AlphaShadow (shading/alpha_shadow.cpp).
#ifndef NACRE_BIND_ALPHA_SHADOW_GLSL
#define NACRE_BIND_ALPHA_SHADOW_GLSL

uniform mat4 nacre_alpha_project;     // world to the map as texture coordinates, homogeneous
uniform vec4 nacre_alpha_depth;       // dot with a world position: depth from the light, near 0 and far 1
uniform mat4 nacre_alpha_light_clip;  // world to the light's clip space
uniform sampler2D nacre_alpha_ramp_texture;
uniform sampler2D nacre_alpha_map;
uniform float nacre_alpha_steps;      // 2^bits - 1 of alpha, or 0
uniform float nacre_alpha_scale;      // 2^bits, of the copy

#endif
