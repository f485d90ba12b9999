// Schlick 1994, a single layer, evaluated directly. C++ twin: factorize/models/schlick.cpp, to 1e-3
// (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_SCHLICK_GLSL
#define NACRE_DIRECT_SCHLICK_GLSL

#include "nacre/direct_fresnel.glsl"

// Z(t)/pi * A(w): r roughness, p isotropy; A is 1 at the pole, where it has no value.
float nacre_schlick_distribution(vec3 h, float r, float p) {
    float s2 = dot(h.xy, h.xy);
    float q = s2 + r * h.z * h.z;
    float zenith = r / (3.14159265 * q * q);
    if (s2 == 0.0) return zenith;
    float w2 = h.x * h.x / s2;
    return zenith * sqrt(p / (p * p * (1.0 - w2) + w2));
}

// G(v) G(v')/(4 v v').
float nacre_schlick_visibility(vec3 wi, vec3 wo, float r) {
    return 0.25 / ((r + (1.0 - r) * wi.z) * (r + (1.0 - r) * wo.z));
}

// The specular term; f0: reflectance at normal incidence.
vec3 nacre_schlick(vec3 wi, vec3 wo, float r, float p, vec3 f0) {
    vec3 sum = wi + wo;
    float size = length(sum);
    return nacre_fresnel_schlick(min(1.0, 0.5 * size), f0) *
           (nacre_schlick_distribution(sum / size, r, p) * nacre_schlick_visibility(wi, wo, r));
}

#endif
