// f = sum of U_k(x) V_k(y), its exponential, or sum of exp(U_k(x) + V_k(y)), Kautz & McCool 1999; or symmetric in wi
// and wo, sum of M_k A_k(wi) A_k(wo) over the channels of the textures. params[0] = (terms; arguments: 0 half and
// difference vector, 1 in and out, 2 symmetric, 3 half and carried difference; storage: 0 values, 1 logarithm of the
// sum, 2 logarithms of the factors; quadrant), params[1].xy = 1/slope width, params[2..9] = M.
// C++ twin: separable in factorize/factored_evaluate.cpp; 2e-3 relative for half textures
// (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_FACTORED_SEPARABLE_GLSL
#define NACRE_FACTORED_SEPARABLE_GLSL

#include "nacre/mappings.glsl"

vec3 nacre_separable_product(vec3 u, vec3 v, float storage) { return storage > 1.5 ? nacre_exp(u + v) : u * v; }

vec3 nacre_separable_symmetric(sampler2D t, vec4 scale, vec4 bias, vec2 x, vec2 y, mat4x3 m) {
    return m * (nacre_lookup(t, x, scale, bias) * nacre_lookup(t, y, scale, bias));
}

vec3 nacre_separable(sampler2D t0, sampler2D t1, sampler2D t2, sampler2D t3, vec4 params[16], vec4 scale[4],
                     vec4 bias[4], vec3 wi, vec3 wo) {
    float storage = params[0].z;
    vec2 x;
    vec2 y;
    if (params[0].y < 0.5 || params[0].y > 2.5) {
        bool quadrant = params[0].w > 0.5;
        NacreHalfGeometry g = nacre_half_geometry(wi, wo);
        x = nacre_map_scaled_slope(g.h, params[1].xy, quadrant);
        vec3 d = params[0].y > 2.5 ? nacre_carried_difference(g.h, wi) : nacre_difference_vector(g.h, wi);
        y = nacre_map_lambert_disk(d, quadrant);
    } else {
        x = nacre_map_lambert_disk(wi, false);
        y = nacre_map_lambert_disk(wo, false);
    }
    vec3 f;
    if (params[0].y > 1.5 && params[0].y < 2.5) {
        f = nacre_separable_symmetric(t0, scale[0], bias[0], x, y,
                                      mat4x3(params[2].xyz, params[3].xyz, params[4].xyz, params[5].xyz));
        if (params[0].x > 1.5)
            f += nacre_separable_symmetric(t1, scale[1], bias[1], x, y,
                                           mat4x3(params[6].xyz, params[7].xyz, params[8].xyz, params[9].xyz));
    } else {
        f = nacre_separable_product(nacre_lookup(t0, x, scale[0], bias[0]).xyz,
                                    nacre_lookup(t1, y, scale[1], bias[1]).xyz, storage);
        if (params[0].x > 1.5)
            f += nacre_separable_product(nacre_lookup(t2, x, scale[2], bias[2]).xyz,
                                         nacre_lookup(t3, y, scale[3], bias[3]).xyz, storage);
    }
    return storage > 0.5 && storage < 1.5 ? nacre_exp(f) : max(f, vec3(0.0));
}

#endif
