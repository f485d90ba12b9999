// The light that shadow volumes are swept from. C++: ShadowStencil (shading/multipass/shadow_stencil.hpp).
#ifndef NACRE_BIND_STENCIL_VOLUME_GLSL
#define NACRE_BIND_STENCIL_VOLUME_GLSL

uniform vec4 nacre_stencil_light;  // homogeneous, in the world: position and 1, or unit direction towards it and 0

#ifdef NACRE_STENCIL_CUT
uniform vec4 nacre_stencil_cut[2];  // planes in the mesh's space

// How far in front of both a point of the mesh is.
vec2 nacre_before_cuts(vec3 point) {
    return vec2(dot(nacre_stencil_cut[0], vec4(point, 1.0)), dot(nacre_stencil_cut[1], vec4(point, 1.0)));
}
#endif

uniform float nacre_stencil_nearer;  // 0; or how much nearer than infinity, see below

// A point in the world swept away from the light to infinity, homogeneous. In a parallel projection all that is at
// infinity has no place: a point's light is swept 1 / nacre_stencil_nearer times as far as the point is there.
vec4 nacre_swept(vec3 point) {
    float w = nacre_stencil_light.w * nacre_stencil_nearer;
    return vec4(point * nacre_stencil_light.w - nacre_stencil_light.xyz * (1.0 - w), w);
}

#endif
