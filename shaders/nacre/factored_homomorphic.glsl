// f = diffuse + C(1 - l.h) exp(Q(h) + P(wi) + P(wo)) / (max^a (ni no)^b (l.h)^c smith): McCool, Ang & Ahmad 2001.
// params[0] = (1/width x, 1/width y, quadrant, has P), params[1] = (a, b, has diffuse texture, c), params[2] = (kd,
// Smith shadowing), params[3..11] = polynomial C, params[12..14] = colour columns.
// C++ twin: homomorphic in factorize/factored_evaluate.cpp; 2e-3 relative for half textures
// (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_FACTORED_HOMOMORPHIC_GLSL
#define NACRE_FACTORED_HOMOMORPHIC_GLSL

#include "nacre/mappings.glsl"

vec3 nacre_homomorphic(sampler2D t0, sampler2D t1, sampler2D t2, vec4 params[16], vec4 scale[4], vec4 bias[4], vec3 wi,
                       vec3 wo) {
    bool quadrant = params[0].z > 0.5;
    bool hasP = params[0].w > 0.5;
    NacreHalfGeometry g = nacre_half_geometry(wi, wo);
    float w = g.oneMinusLh;
    vec3 c = vec3(0.0);
    for (int k = 11; k >= 3; --k) c = c * w + params[k].xyz;
    vec3 t = nacre_lookup(t0, nacre_map_scaled_slope(g.h, params[0].xy, quadrant), scale[0], bias[0]).xyz;
    if (hasP)
        t += nacre_lookup(t1, nacre_map_lambert_disk(wi, quadrant), scale[1], bias[1]).xyz +
             nacre_lookup(t1, nacre_map_lambert_disk(wo, quadrant), scale[1], bias[1]).xyz;
    float powers = params[1].x * log(max(wi.z, wo.z)) + params[1].y * log(wi.z * wo.z) +
                   params[1].w * log(max(1.0 - w, 1e-6));
    vec3 y = params[12].xyz * t.x + params[13].xyz * t.y + params[14].xyz * t.z - powers;
    float smith = nacre_smith_denominator(params[2].w, 1.0 / params[0].xy, wi, wo);
    vec3 f = params[2].xyz + max(c, vec3(0.0)) * nacre_exp(y) / smith;
    if (params[1].z > 0.5) {
        vec2 uv = nacre_map_elevations(wi.z, wo.z);
        if (hasP) f += nacre_lookup(t2, uv, scale[2], bias[2]).xyz;
        else f += nacre_lookup(t1, uv, scale[1], bias[1]).xyz;
    }
    return f;
}

#endif
