// A specular face that light passes. C++: drawFace (shading/multipass/pass_runner.cpp).
#ifndef NACRE_BIND_FACE_GLSL
#define NACRE_BIND_FACE_GLSL

#include "nacre/direct_fresnel.glsl"

uniform vec3 nacre_face_normal;
uniform float nacre_face_index;     // beyond over before, > 0; 0: keeps all
uniform int nacre_face_reflects;    // 1: what is reflected; 0: what is refracted
uniform float nacre_face_surface;   // share of the own light, times the texture's alpha
uniform sampler2D nacre_face_texture;

// Share of the light that leaves the face to the viewer, by Fresnel. to_eye: unit. C++: fresnelDielectric
// (core/fresnel.hpp), to 1e-4.
float nacre_face_share(vec3 to_eye) {
    if (nacre_face_index == 0.0) return 1.0;
    float reflected = nacre_fresnel_dielectric(min(abs(dot(nacre_face_normal, to_eye)), 1.0), nacre_face_index);
    return nacre_face_reflects == 1 ? reflected : 1.0 - reflected;
}

// rgb: factor of the own light; alpha: of its share.
vec4 nacre_face_texel(vec2 uv) { return texture(nacre_face_texture, uv); }

#endif
