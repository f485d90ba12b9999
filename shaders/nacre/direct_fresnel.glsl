// Fresnel reflectance at a smooth interface, cos_theta in [0, 1]. C++ twins: core/fresnel.hpp, same formulas and the
// same guards; to 1e-4 relative (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_FRESNEL_GLSL
#define NACRE_DIRECT_FRESNEL_GLSL

// (1 - c)^5, Schlick 1994.
float nacre_schlick_weight(float c) {
    float m = clamp(1.0 - c, 0.0, 1.0);
    return m * m * m * m * m;
}

// f0 + (1 - f0)(1 - c)^5, Schlick 1994, eq. 15.
vec3 nacre_fresnel_schlick(float c, vec3 f0) { return f0 + (vec3(1.0) - f0) * nacre_schlick_weight(c); }

// Exact, dielectric of relative index eta > 0; eta = 1 is no interface.
float nacre_fresnel_dielectric(float c, float eta) {
    if (eta == 1.0) return 0.0;
    float contrast = (eta - 1.0) * (eta + 1.0);
    float g2 = contrast + c * c;
    if (g2 <= 0.0) return 1.0;
    float sum = sqrt(g2) + c;
    float difference = contrast / sum;
    float ratio = (c * sum - 1.0) / (c * difference + 1.0);
    float s = difference / sum;
    return min(1.0, 0.5 * s * s * (1.0 + ratio * ratio));
}

// Exact, conductor of index eta + ik.
float nacre_fresnel_conductor(float c, float eta, float k) {
    if (eta == 1.0 && k == 0.0) return 0.0;
    float c2 = c * c;
    float s2 = 1.0 - c2;
    float re = (eta - k) * (eta + k) - s2;
    float im = 2.0 * eta * k;
    float modulus = length(vec2(re, im));
    float a;
    float b;
    if (re >= 0.0) {
        a = sqrt(0.5 * (modulus + re));
        b = a > 0.0 ? eta * k / a : 0.0;
    } else {
        b = sqrt(0.5 * (modulus - re));
        a = eta * k / b;
    }
    float sum = a + c;
    if (sum == 0.0) return 1.0;
    float difference = ((eta - 1.0) * (eta + 1.0) - k * k + b * b) / sum;
    float rs = (difference * difference + b * b) / (sum * sum + b * b);
    float p = a * c - s2;
    float q = a * c + s2;
    float rp = rs * (p * p + b * b * c2) / (q * q + b * b * c2);
    return min(1.0, 0.5 * (rs + rp));
}

vec3 nacre_fresnel_dielectric3(float c, vec3 eta) {
    return vec3(nacre_fresnel_dielectric(c, eta.r), nacre_fresnel_dielectric(c, eta.g),
                nacre_fresnel_dielectric(c, eta.b));
}

vec3 nacre_fresnel_conductor3(float c, vec3 eta, vec3 k) {
    return vec3(nacre_fresnel_conductor(c, eta.r, k.r), nacre_fresnel_conductor(c, eta.g, k.g),
                nacre_fresnel_conductor(c, eta.b, k.b));
}

#endif
