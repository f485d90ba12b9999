// Light that mirrors and panes sent on (VirtualLight, shading/multipass/virtual_light.hpp, where it is derived). C++:
// setLightPath (shading/multipass/light_passes.hpp).
// #define NACRE_LIGHT_PATH: how many faces weigh it by Fresnel; the lamp's cone is asked in the direction in which it
// left. #define NACRE_PATH_IMAGES: how many faces, of which some have a picture or fog.
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

#ifdef NACRE_PATH_IMAGES
#include "nacre/bind/face_images.glsl"

uniform mat4 nacre_path_place[4];  // of (x, 1) to (u w, v w, w, h), the last face first; h: what fog takes behind it,
                                   // times the w of the face after it
uniform vec4 nacre_path_rect[4];   // of each picture
uniform vec4 nacre_path_use[4];    // 1: its rgb are factors, 0: not; what isn't sent on, times its alpha

// What the faces leave of light that arrives at a point.
vec3 nacre_path_color(vec3 point) {
    vec3 color = vec3(1.0);
    float w = 1.0;
    for (int i = 0; i < NACRE_PATH_IMAGES; ++i) {
        vec4 at = nacre_path_place[i] * vec4(point, 1.0);
        color *= 1.0 - clamp(at.w / w, 0.0, 1.0);
        w = at.z;
        if (nacre_path_rect[i].z == 0.0) continue;
        vec4 texel = nacre_face_image(nacre_face_images, nacre_path_rect[i], at.xy / w);
        color *= mix(vec3(1.0), texel.rgb, nacre_path_use[i].x) * (1.0 - nacre_path_use[i].y * texel.a);
    }
    return color;
}
#else
vec3 nacre_path_color(vec3 point) { return vec3(1.0); }
#endif

#endif
