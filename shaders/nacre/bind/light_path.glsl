// Light that panes sent on (VirtualLight, shading/multipass/virtual_light.hpp, where it is derived). #define
// NACRE_LIGHT_PATH: how many faces weigh it by Fresnel; the lamp's cone is asked in the direction in which it left. C++: setLightPath
// (shading/multipass/light_passes.hpp).
#ifndef NACRE_BIND_LIGHT_PATH_GLSL
#define NACRE_BIND_LIGHT_PATH_GLSL

#ifdef NACRE_LIGHT_PATH
#include "nacre/direct_fresnel.glsl"

uniform mat3 nacre_path_to_lamp;
uniform mat4 nacre_path_turn[4];  // the direction to the virtual light to that before each face
uniform vec4 nacre_path_face[4];  // its normal; index beyond over before, < 0: of what is reflected

// to_light: unit, to the virtual light.
vec3 nacre_path_at_lamp(vec3 to_light) { return normalize(nacre_path_to_lamp * to_light); }

float nacre_path_share(vec3 to_light) {
    float stretch = length(nacre_path_to_lamp * to_light);
    float share = 1.0 / (stretch * stretch * stretch);
    for (int i = 0; i < NACRE_LIGHT_PATH; ++i) {
        vec3 before = normalize(mat3(nacre_path_turn[i]) * to_light);
        vec4 face = nacre_path_face[i];
        float reflected = nacre_fresnel_dielectric(min(abs(dot(face.xyz, before)), 1.0), abs(face.w));
        share *= face.w < 0.0 ? reflected : 1.0 - reflected;
    }
    return share;
}
#else
vec3 nacre_path_at_lamp(vec3 to_light) { return to_light; }
float nacre_path_share(vec3 to_light) { return 1.0; }
#endif

#endif
