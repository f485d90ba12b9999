// From linear light to what a screen shows.
#ifndef NACRE_TONE_GLSL
#define NACRE_TONE_GLSL

// sRGB transfer (IEC 61966-2-1) of linear values, clamped to [0, 1]. C++: srgbEncode (reference/tone.hpp), within 1e-4.
vec3 nacre_srgb_encode(vec3 linear) {
    vec3 v = clamp(linear, 0.0, 1.0);
    vec3 curve = 1.055 * pow(max(v, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
    return mix(curve, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
}

#endif
