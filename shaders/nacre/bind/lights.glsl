// The lights, as core/scene.hpp's Light. C++: drawLit (shading/lit_pass.cpp).
#ifndef NACRE_BIND_LIGHTS_GLSL
#define NACRE_BIND_LIGHTS_GLSL

// Their number: a literal where the program gives it (#define NACRE_LIGHTS 5). The loops then unroll; drivers that run
// all pixels of a group in step pay two to three times as much for a loop whose end they don't know.
#ifdef NACRE_LIGHTS
#define NACRE_LIGHT_COUNT NACRE_LIGHTS
#else
uniform int nacre_light_count;
#define NACRE_LIGHT_COUNT nacre_light_count
#endif
uniform vec4 nacre_light_position[8];  // w = 0: unit direction towards the light; w = 1: position of a point light
uniform vec3 nacre_light_color[8];     // irradiance on a facing surface, or intensity of a point light
uniform vec3 nacre_ambient;            // radiance added to every point

#endif
