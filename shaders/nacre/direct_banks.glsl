// Banks 1994 (HSE eq. 4 without its cosine), evaluated directly. C++ twin: factorize/models/banks.cpp, to 1e-3
// (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_DIRECT_BANKS_GLSL
#define NACRE_DIRECT_BANKS_GLSL

// tl, tv: tangent times light and view; sl = sqrt(1 - tl^2) is n'.l, and n'.h = sqrt((1 + sl sv - tl tv)/2), whose
// distance from 1, ((sl - sv)^2 + (tl + tv)^2)/4 for the square, keeps the digits of a sharp highlight.
vec3 nacre_banks(float tl, float tv, float n, vec3 kd, vec3 ks) {
    float sl = sqrt(max(0.0, (1.0 - tl) * (1.0 + tl)));
    float sv = sqrt(max(0.0, (1.0 - tv) * (1.0 + tv)));
    vec2 d = vec2(sl - sv, tl + tv);
    float q = min(0.25 * dot(d, d), 1.0);  // 1 - (n'.h)^2
    float logCos2 = q < 0.05 ? -q * (1.0 + q * (0.5 + q * (1.0 / 3.0 + q * (0.25 + q * 0.2))))
                             : log(max(1.0 - q, 1e-30));
    return kd * sl + ks * exp(0.5 * n * logCos2);
}

#endif
