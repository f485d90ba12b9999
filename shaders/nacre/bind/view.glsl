// Where the picture is taken from. C++: drawLit (shading/lit_pass.cpp).
#ifndef NACRE_BIND_VIEW_GLSL
#define NACRE_BIND_VIEW_GLSL

uniform mat4 nacre_world_to_clip;
uniform vec4 nacre_eye;  // w = 1: position of the eye; w = 0: unit direction towards an orthographic viewer

// A virtual viewpoint (shading/multipass/). C++: setView (shading/multipass/view_state.hpp).
#ifdef NACRE_VIEW
uniform vec4 nacre_view_clip;    // a plane: what lies in front of it is seen
uniform vec3 nacre_view_factor;  // of all that is drawn: what the path to the eye keeps
uniform float nacre_view_share;  // of a surface's light: what of it is not specular
uniform vec4 nacre_view_fog;     // the radiance that all fades to, and 1 / distance from the plane where it has; 0: none

// Of the faces on the way whose pictures filter what is seen in them: #define NACRE_VIEW_FILTERS, how many.
#ifdef NACRE_VIEW_FILTERS
#include "nacre/bind/face_images.glsl"

uniform mat4 nacre_view_place[8];  // of (x, 1) to (u w, v w, w, -)
uniform vec4 nacre_view_rect[8];   // of each picture

// Their product at the points through which a place is seen; homogeneous.
vec3 nacre_view_filter(vec4 position) {
    vec3 product = vec3(1.0);
    for (int i = 0; i < NACRE_VIEW_FILTERS; ++i) {
        vec4 at = nacre_view_place[i] * position;
        product *= nacre_face_image(nacre_face_images, nacre_view_rect[i], at.xy / at.z).rgb;
    }
    return product;
}
#else
vec3 nacre_view_filter(vec4 position) { return vec3(1.0); }
#endif

// What fog leaves of the light from a place.
float nacre_view_clear(vec3 position) {
    return 1.0 - clamp(dot(nacre_view_clip, vec4(position, 1.0)) * nacre_view_fog.w, 0.0, 1.0);
}

// Light from a place, as it reaches the eye.
vec3 nacre_view_seen(vec3 light, vec3 position) {
    vec3 factor = nacre_view_factor * nacre_view_filter(vec4(position, 1.0));
    return factor * mix(nacre_view_fog.rgb, nacre_view_share * light, nacre_view_clear(position));
}

// The same from infinitely far. position: of the far plane, homogeneous.
vec3 nacre_view_background(vec3 light, vec4 position) {
    vec3 factor = nacre_view_factor * nacre_view_filter(position);
    return factor * (nacre_view_fog.w > 0.0 ? nacre_view_fog.rgb : light);
}
#endif

#endif
