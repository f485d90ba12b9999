// V = G/(4 cos(alpha) cos(beta)) of micro-facets, wi.z and wo.z > 0; finite where G and the cosines vanish together.
// C++ twins: factorize/models/geometry.hpp, to 1e-4 relative (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_VISIBILITY_GLSL
#define NACRE_DIRECT_VISIBILITY_GLSL

// erf(x) for x >= 0, Abramowitz & Stegun 7.1.26: absolute error below 2e-7.
float nacre_erf_positive(float x) {
    float t = 1.0 / (1.0 + 0.3275911 * x);
    float p = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    return 1.0 - p * exp(-x * x);
}

// Smith masking of Beckmann slopes over the cosine: 2/(cos (1 + erf a) + alpha sin exp(-a^2)/sqrt(pi)), a = cos/(alpha sin).
float nacre_beckmann_g1_over_cos(vec3 w, float alpha) {
    float slope = alpha * length(w.xy);
    if (w.z > 6.0 * slope) return 1.0 / w.z;
    float a = w.z / slope;
    return 2.0 / (w.z * (1.0 + nacre_erf_positive(a)) + slope * exp(-a * a) * 0.56418958);
}

float nacre_visibility_beckmann_smith(vec3 wi, vec3 wo, float alpha) {
    return 0.25 * nacre_beckmann_g1_over_cos(wi, alpha) * nacre_beckmann_g1_over_cos(wo, alpha);
}

// Length of the stretched direction, Heitz 2014, eq. 86.
float nacre_ggx_radius(vec3 w, vec2 alpha) { return length(vec3(alpha * w.xy, w.z)); }

float nacre_visibility_ggx_smith(vec3 wi, vec3 wo, vec2 alpha) {
    return 1.0 / ((wi.z + nacre_ggx_radius(wi, alpha)) * (wo.z + nacre_ggx_radius(wo, alpha)));
}

// Height-correlated, Heitz 2014, eq. 99.
float nacre_visibility_ggx_correlated(vec3 wi, vec3 wo, vec2 alpha) {
    return 0.5 / (wo.z * nacre_ggx_radius(wi, alpha) + wi.z * nacre_ggx_radius(wo, alpha));
}

// V-shaped grooves, Cook & Torrance 1982: min(1, 2 (n.h) min(n.wi, n.wo)/(wo.h)).
float nacre_visibility_v_cavity(vec3 wi, vec3 wo) {
    vec3 sum = wi + wo;
    float slope = 4.0 * sum.z / dot(sum, sum);
    return 0.25 * min(1.0 / (wi.z * wo.z), slope / max(wi.z, wo.z));
}

#endif
