// f = kd + A(cos theta_d, cos delta) * B(cos alpha, cos beta) / cos alpha, HSE section 1.1. params[1] = kd,
// params[2..4] = colour columns of A.
// C++ twin: cosine in factorize/factored_evaluate.cpp; 2e-3 relative for half textures
// (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_FACTORED_COSINE_GLSL
#define NACRE_FACTORED_COSINE_GLSL

#include "nacre/mappings.glsl"

// From the coordinates alone, as texture matrices give them (HSE eq. 2 and 3). ab: cos theta_d, cos delta; elevations:
// cos alpha, cos beta.
vec3 nacre_cosine_at(sampler2D t0, sampler2D t1, vec4 params[16], vec4 scale[4], vec4 bias[4], vec2 ab,
                     vec2 elevations) {
    vec3 a = nacre_lookup(t0, clamp(ab, 0.0, 1.0), scale[0], bias[0]).xyz;
    float b = nacre_lookup(t1, clamp(elevations, 0.0, 1.0), scale[1], bias[1]).x;
    return params[1].xyz + (params[2].xyz * a.x + params[3].xyz * a.y + params[4].xyz * a.z) * (b / elevations.x);
}

vec3 nacre_cosine(sampler2D t0, sampler2D t1, vec4 params[16], vec4 scale[4], vec4 bias[4], vec3 wi, vec3 wo) {
    NacreHalfGeometry g = nacre_half_geometry(wi, wo);
    return nacre_cosine_at(t0, t1, params, scale, bias, vec2(1.0 - g.oneMinusLh, g.h.z), vec2(wi.z, wo.z));
}

#endif
