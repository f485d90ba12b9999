// f = sum of U_k(x) V_k(y), Kautz & McCool 1999. params[0] = (terms, 0 for half/difference or 1 for in/out,
// logarithmic), params[1].xy = 1/slope width.
// C++ twin: separable in factorize/factored_evaluate.cpp; 2e-3 relative for half textures
// (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_FACTORED_SEPARABLE_GLSL
#define NACRE_FACTORED_SEPARABLE_GLSL

#include "nacre/mappings.glsl"

vec3 nacre_separable(sampler2D t0, sampler2D t1, sampler2D t2, sampler2D t3, vec4 params[16], vec4 scale[4],
                     vec4 bias[4], vec3 wi, vec3 wo) {
    vec2 x;
    vec2 y;
    if (params[0].y < 0.5) {
        NacreHalfGeometry g = nacre_half_geometry(wi, wo);
        x = nacre_map_scaled_slope(g.h, params[1].xy, false);
        y = nacre_map_lambert_disk(nacre_difference_vector(g.h, wi), false);
    } else {
        x = nacre_map_lambert_disk(wi, false);
        y = nacre_map_lambert_disk(wo, false);
    }
    vec3 f = nacre_lookup(t0, x, scale[0], bias[0]).xyz * nacre_lookup(t1, y, scale[1], bias[1]).xyz;
    if (params[0].x > 1.5) f += nacre_lookup(t2, x, scale[2], bias[2]).xyz * nacre_lookup(t3, y, scale[3], bias[3]).xyz;
    return params[0].z > 0.5 ? nacre_exp(f) : f;
}

#endif
