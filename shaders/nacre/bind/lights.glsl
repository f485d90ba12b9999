// The lights, as core/scene.hpp's Light. C++: drawLit (shading/lit_pass.cpp).
#ifndef NACRE_BIND_LIGHTS_GLSL
#define NACRE_BIND_LIGHTS_GLSL

uniform int nacre_light_count;
uniform vec4 nacre_light_position[8];  // w = 0: unit direction towards the light; w = 1: position of a point light
uniform vec3 nacre_light_color[8];     // irradiance on a facing surface, or intensity of a point light
uniform vec3 nacre_ambient;            // radiance added to every point

#endif
