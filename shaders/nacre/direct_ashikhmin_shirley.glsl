// Ashikhmin & Shirley 2000, eq. 3 to 5, evaluated directly. C++ twin: factorize/models/ashikhmin_shirley.cpp, to 1e-3
// (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_ASHIKHMIN_SHIRLEY_GLSL
#define NACRE_DIRECT_ASHIKHMIN_SHIRLEY_GLSL

#include "nacre/direct_distribution.glsl"
#include "nacre/direct_fresnel.glsl"

// n: exponents along tangent and bitangent; scale: sqrt((nu+1)(nv+1))/(2 pi); diffuse: 28/(23 pi) rd (1 - rs).
vec3 nacre_ashikhmin_shirley(vec3 wi, vec3 wo, vec2 n, float scale, vec3 rs, vec3 diffuse) {
    vec3 sum = wi + wo;
    float size = length(sum);
    float c = min(1.0, 0.5 * size);
    float lobe = scale * nacre_power_cos_ellipse(sum / size, n) * 0.25 / (c * max(wi.z, wo.z));
    float rise = (1.0 - nacre_schlick_weight(0.5 * wi.z)) * (1.0 - nacre_schlick_weight(0.5 * wo.z));
    return diffuse * rise + nacre_fresnel_schlick(c, rs) * lobe;
}

#endif
