// Shadow maps by the alpha test (HSE section 2.1): depth from the light, mapped linearly to alpha.
#ifndef NACRE_ALPHA_SHADOW_GLSL
#define NACRE_ALPHA_SHADOW_GLSL

// The one-dimensional texture at coordinate s, clamped and interpolated between texel centres; OpenGL ES has no 1D
// textures, so its height is 1. steps: alpha is rounded to k / steps, as registers of 8 and 16 bits hold it; 0: not.
// C++: alphaRamp (shading/alpha_shadow.hpp), to 1e-6 (tests/shading/alpha_shadow_test.cpp).
float nacre_alpha_ramp(sampler2D ramp, float s, float steps) {
    int last = textureSize(ramp, 0).x - 1;
    float at = clamp(s, 0.0, 1.0) * float(last);
    int i = min(int(at), last - 1);
    float alpha = mix(texelFetch(ramp, ivec2(i, 0), 0).r, texelFetch(ramp, ivec2(i + 1, 0), 0).r, at - float(i));
    return steps > 0.0 ? floor(alpha * steps + 0.5) / steps : alpha;
}

// The map as a projective texture; 1 outside of it and behind the light: nothing casts a shadow there.
float nacre_alpha_projected(sampler2D map, vec4 place) {
    vec2 at = place.xy / place.w;
    bool outside = place.w <= 0.0 || at.x < 0.0 || at.y < 0.0 || at.x > 1.0 || at.y > 1.0;
    float alpha = texture(map, outside ? vec2(0.5) : at).a;
    return outside ? 1.0 : alpha;
}

// What the combiner computes: 0 where lit, > 0 where shadowed.
float nacre_alpha_difference(float receiver, float stored) { return clamp(receiver - stored, 0.0, 1.0); }

#endif
