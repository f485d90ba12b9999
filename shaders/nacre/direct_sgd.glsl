// Shifted gamma distribution (Bagher, Soler & Holzschuch 2012), every parameter per colour channel, evaluated directly:
// the expensive model. C++ twin: evaluateSgd (factorize/models/sgd.hpp), to 2e-3 (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_SGD_GLSL
#define NACRE_DIRECT_SGD_GLSL

#include "nacre/direct_fresnel.glsl"

// G1(theta) = 1 for theta <= theta0, else 1 + lambda (1 - exp(c (theta - theta0)^k)), kept in [0, 1].
vec3 nacre_sgd_masking(float theta, vec3 theta0, vec3 lambda, vec3 c, vec3 k) {
    vec3 excess = vec3(theta) - theta0;
    vec3 growth = min(c * pow(max(excess, vec3(1e-6)), k), vec3(80.0));  // e^80 is beyond any lambda's reach
    vec3 g = clamp(vec3(1.0) + lambda * (vec3(1.0) - exp(growth)), 0.0, 1.0);
    return mix(g, vec3(1.0), vec3(lessThanEqual(excess, vec3(0.0))));
}

// D = kap exp(-y) y^(-p) / (pi cos^4), y = alpha + tan^2/alpha; times pi.
vec3 nacre_sgd_distribution(vec3 h, vec3 alpha, vec3 p, vec3 kap) {
    float c2 = h.z * h.z;
    vec3 y = alpha + vec3(dot(h.xy, h.xy) / c2) / alpha;
    return kap * exp(-min(y + p * log(y), vec3(80.0))) / (c2 * c2);
}

// F = f0 - f1 c + (1 - f0)(1 - c)^5, not below 0.
vec3 nacre_sgd_fresnel(float c, vec3 f0, vec3 f1) {
    return max(f0 - f1 * c + (vec3(1.0) - f0) * nacre_schlick_weight(c), vec3(0.0));
}

// The specular term. m[2 .. 11]: rho_s, alpha, p, f0, f1, kap, lambda, c, k, theta0.
vec3 nacre_sgd(vec3 wi, vec3 wo, vec4 m[16]) {
    vec3 sum = wi + wo;
    float size = length(sum);
    vec3 d = nacre_sgd_distribution(sum / size, m[3].rgb, m[4].rgb, m[7].rgb);
    vec3 f = nacre_sgd_fresnel(min(1.0, 0.5 * size), m[5].rgb, m[6].rgb);
    vec3 g = nacre_sgd_masking(atan(length(wi.xy), wi.z), m[11].rgb, m[8].rgb, m[9].rgb, m[10].rgb) *
             nacre_sgd_masking(atan(length(wo.xy), wo.z), m[11].rgb, m[8].rgb, m[9].rgb, m[10].rgb);
    return m[2].rgb * f * d * g / (9.8696044 * wi.z * wo.z);
}

#endif
