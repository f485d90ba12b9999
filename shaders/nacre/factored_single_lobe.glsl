// f = (T(s, cos alpha) - ambient) / cos alpha: Phong, Blinn-Phong, cosine lobes (HSE section 1.1). params[0] =
// (w0, 0 for s = n.h or 1 for s = (axis * wi).wo, 0 for a unit axis), params[1] = ambient, params[2] = axis.
// C++ twin: singleLobe in factorize/factored_evaluate.cpp; 2e-3 relative for half textures
// (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_FACTORED_SINGLE_LOBE_GLSL
#define NACRE_FACTORED_SINGLE_LOBE_GLSL

#include "nacre/mappings.glsl"

vec3 nacre_single_lobe(sampler2D t0, vec4 params[16], vec4 scale[4], vec4 bias[4], vec3 wi, vec3 wo) {
    float oneMinusS;
    if (params[0].y < 0.5) {
        NacreHalfGeometry g = nacre_half_geometry(wi, wo);
        oneMinusS = g.lengthXY * g.lengthXY / (1.0 + g.h.z);
    } else {
        vec3 a = params[2].xyz * wi;
        vec3 gap = a - wo;
        oneMinusS = 0.5 * (params[0].z * (1.0 - dot(a, a)) + dot(gap, gap));
    }
    vec3 t = nacre_lookup(t0, vec2(nacre_map_lobe(oneMinusS, params[0].x), wi.z), scale[0], bias[0]).xyz;
    return (t - params[1].xyz) / wi.z;
}

#endif
