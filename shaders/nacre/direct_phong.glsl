// Models of one cosine power, evaluated directly; scale holds ks and the normalisation. C++ twin:
// factorize/models/phong.cpp, to 1e-3 (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_PHONG_GLSL
#define NACRE_DIRECT_PHONG_GLSL

#include "nacre/direct_distribution.glsl"

// Blinn-Phong: (n.h)^e. 0 for n.h <= 0, which directions above the horizon don't have.
vec3 nacre_blinn_phong(vec3 wi, vec3 wo, float e, vec3 scale) {
    return scale * nacre_power_cos(normalize(wi + wo), e);
}

// Cosine lobe (Lafortune 1997, eq. 6): (axis . (wi * wo))^e; Phong has the axis (-1, -1, 1). For that one s is taken from
// the distance of wo to the mirrored wi, s = 1 - d^2/2, which keeps its digits at the peak.
vec3 nacre_cosine_lobe(vec3 wi, vec3 wo, vec3 axis, float e, vec3 scale) {
    float s = dot(axis, wi * wo);
    if (s <= 0.0) return vec3(0.0);
    if (axis == vec3(-1.0, -1.0, 1.0)) {
        vec3 d = wo - axis * wi;
        float q = 0.5 * dot(d, d);
        if (q < 0.05) return scale * exp(-e * q * (1.0 + q * (0.5 + q * (1.0 / 3.0 + q * (0.25 + q * 0.2)))));
    }
    return scale * pow(min(s, 1.0), e);
}

#endif
