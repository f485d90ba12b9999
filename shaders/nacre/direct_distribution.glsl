// Micro-facet distributions D(h) [1/sr] and powers of cos(delta), delta the angle of h to the normal. Tangents come from
// the components of h: narrow lobes keep their digits. C++ twins: factorize/models/distributions.hpp, to 1e-3 relative
// to the peak for alpha >= 1e-3 (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_DISTRIBUTION_GLSL
#define NACRE_DIRECT_DISTRIBUTION_GLSL

// Beckmann: exp(-tan^2/alpha^2) / (pi alpha^2 cos^4).
float nacre_distribution_beckmann(vec3 h, float alpha) {
    if (h.z < 1e-6) return 0.0;
    float c2 = h.z * h.z;
    float a2 = alpha * alpha;
    return exp(-dot(h.xy, h.xy) / (c2 * a2)) / (3.14159265 * a2 * c2 * c2);
}

// GGX, elliptical: 1 / (pi ax ay ((x/ax)^2 + (y/ay)^2 + z^2)^2).
float nacre_distribution_ggx(vec3 h, vec2 alpha) {
    vec2 s = h.xy / alpha;
    float q = dot(s, s) + h.z * h.z;
    return 1.0 / (3.14159265 * alpha.x * alpha.y * q * q);
}

// Gaussian of the angle: scale * exp(-(delta/alpha)^2).
float nacre_distribution_gaussian(vec3 h, float alpha, float scale) {
    float delta = atan(length(h.xy), h.z) / alpha;
    return scale * exp(-delta * delta);
}

// Ward's elliptical Gaussian of the slopes: exp(-((x/ax)^2 + (y/ay)^2)/z^2) / (pi ax ay).
float nacre_distribution_ward(vec3 h, vec2 alpha) {
    if (h.z < 1e-6) return 0.0;
    vec2 s = h.xy / (alpha * h.z);
    return exp(-dot(s, s)) / (3.14159265 * alpha.x * alpha.y);
}

// log(cos)/sin^2 of a direction, -1/2 at the pole: n log(cos) keeps its digits there for exponents of 1e6.
float nacre_log_cos_over_sin2(vec3 h) {
    float s2 = dot(h.xy, h.xy);
    if (s2 < 0.05) return -0.5 - s2 * (0.25 + s2 * (1.0 / 6.0 + s2 * (0.125 + s2 * 0.1)));
    return log(max(h.z, 1e-30)) / s2;
}

// cos^n of the angle of h.
float nacre_power_cos(vec3 h, float n) { return exp(n * dot(h.xy, h.xy) * nacre_log_cos_over_sin2(h)); }

// Ashikhmin-Shirley: cos^((nu x^2 + nv y^2)/sin^2).
float nacre_power_cos_ellipse(vec3 h, vec2 n) {
    return exp(dot(n, h.xy * h.xy) * nacre_log_cos_over_sin2(h));
}

#endif
