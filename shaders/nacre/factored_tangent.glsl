// f = T(t.l, t.v): Banks (HSE eq. 4 without its cos alpha).
// C++ twin: tangent in factorize/factored_evaluate.cpp; 2e-3 relative for half textures
// (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_FACTORED_TANGENT_GLSL
#define NACRE_FACTORED_TANGENT_GLSL

#include "nacre/mappings.glsl"

// From the coordinates alone, as a texture matrix gives them (HSE eq. 3 with the tangent). along: t.wi, t.wo.
vec3 nacre_tangent_at(sampler2D t0, vec4 params[16], vec4 scale[4], vec4 bias[4], vec2 along) {
    return nacre_lookup(t0, nacre_map_tangent(along.x, along.y), scale[0], bias[0]).xyz;
}

vec3 nacre_tangent(sampler2D t0, vec4 params[16], vec4 scale[4], vec4 bias[4], vec3 wi, vec3 wo) {
    return nacre_tangent_at(t0, params, scale, bias, vec2(wi.x, wo.x));
}

#endif
