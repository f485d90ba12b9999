// f = kd + exp(logarithms over half and difference angle). params[0] = (slope, layout), params[1] = kd,
// params[2..4] = colour columns.
// C++ twin: halfDiff in factorize/factored_evaluate.cpp; 2e-3 relative for half textures
// (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_FACTORED_HALF_DIFF_GLSL
#define NACRE_FACTORED_HALF_DIFF_GLSL

#include "nacre/mappings.glsl"

vec3 nacre_half_diff(sampler2D t0, sampler2D t1, vec4 params[16], vec4 scale[4], vec4 bias[4], vec3 wi, vec3 wo) {
    NacreHalfGeometry g = nacre_half_geometry(wi, wo);
    vec2 uv = nacre_map_half_diff(g, params[0].x);
    float layout_ = params[0].y;  // 0 product, 1 harmonics, 2 compact, 3 grazing
    vec4 a = nacre_lookup(t0, uv, scale[0], bias[0]);
    vec3 k;                       // amounts of the three colour columns
    float grey = 0.0;
    if (layout_ < 0.5) {
        k = a.xyz;
        grey = nacre_lookup(t1, nacre_map_elevations(wi.z, wo.z), scale[1], bias[1]).x;
    } else {
        float x = nacre_cos_squared_phi_d(g, wi, wo);
        if (layout_ < 1.5) {
            vec4 b = nacre_lookup(t1, uv, scale[1], bias[1]);
            k = vec3(a.x + x * (a.y + x * (a.z + x * b.x)), a.w + x * b.y, b.z + x * b.w);
        } else {
            k = vec3(a.x + x * a.y, a.z, a.w);
            if (layout_ > 2.5) k += nacre_lookup(t1, nacre_map_elevations(wi.z, wo.z), scale[1], bias[1]).xyz;
        }
    }
    return params[1].xyz + nacre_exp(params[2].xyz * k.x + params[3].xyz * k.y + params[4].xyz * k.z + grey);
}

#endif
