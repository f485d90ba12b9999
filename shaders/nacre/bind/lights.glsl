// The lights, as core/scene.hpp's Light. C++: drawLit (shading/lit_pass.cpp).
#ifndef NACRE_BIND_LIGHTS_GLSL
#define NACRE_BIND_LIGHTS_GLSL

#include "nacre/bind/light_path.glsl"
#include "nacre/light.glsl"

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
uniform vec4 nacre_light_cone[8];      // of spots, see nacre_cone_share; only with #define NACRE_LIGHT_CONES
uniform vec3 nacre_ambient;            // radiance added to every point

// Share of light i's color that reaches a facing surface at `point`; to_light: unit. Not shadowed. C++: lightFalloff
// (core/scene.hpp), to 1e-4 (tests/shading/light_test.cpp).
float nacre_light_share(int i, vec3 to_light, vec3 point) {
    float share = nacre_light_falloff(nacre_light_position[i], point) * nacre_path_share(to_light);
#ifdef NACRE_LIGHT_CONES
    share *= nacre_cone_share(nacre_light_cone[i], nacre_path_at_lamp(to_light));
#endif
    return share;
}

#endif
