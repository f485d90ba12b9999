// A specular face that light passes. C++: drawFace (shading/multipass/pass_runner.cpp).
#ifndef NACRE_BIND_FACE_GLSL
#define NACRE_BIND_FACE_GLSL

#include "nacre/direct_fresnel.glsl"

uniform vec3 nacre_face_normal;
uniform float nacre_face_index;     // beyond over before, > 0; 0: keeps all
uniform int nacre_face_reflects;    // 1: what is reflected; 0: what is refracted
uniform float nacre_face_surface;   // share of the own light, times the texture's alpha
uniform sampler2D nacre_face_texture;

// The way back from the eye to the face, over refracting faces: a virtual eye's direction is right for one angle alone,
// and far from it a pane seems wholly reflective. #define NACRE_FACE_STEPS: how many, the last on the way first.
#ifdef NACRE_FACE_STEPS
uniform vec4 nacre_step_plane[4], nacre_step_eye[4];  // a face's plane; the virtual eye behind it
uniform vec4 nacre_step_index;                         // of each beyond over before; 0: a mirror
uniform vec4 nacre_step_first;                         // the eye before all

// Unit, towards where the pixel's own ray comes from; (0, 0, 0) where it would be wholly reflected on its way.
vec3 nacre_face_to_eye(vec3 position) {
    vec3 at = position;
    for (int i = 0; i < NACRE_FACE_STEPS; ++i) {
        vec4 plane = nacre_step_plane[i], eye = nacre_step_eye[i];
        vec4 met = vec4(at, 1.0) - dot(plane, vec4(at, 1.0)) / dot(plane, eye) * eye;
        at = met.xyz / met.w;
    }
    vec3 along = nacre_step_first.w == 0.0 ? -nacre_step_first.xyz : normalize(at - nacre_step_first.xyz);
    for (int i = NACRE_FACE_STEPS - 1; i >= 0; --i) {
        vec3 normal = nacre_step_plane[i].xyz;
        normal = dot(normal, along) > 0.0 ? -normal : normal;
        along = nacre_step_index[i] == 0.0 ? reflect(along, normal) : refract(along, normal, 1.0 / nacre_step_index[i]);
    }
    return -along;
}
#endif

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
