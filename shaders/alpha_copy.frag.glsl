// The framebuffer onto itself, alpha scaled: 1/2^n, the least that is more than 0, becomes 1. Floats were not clamped.
#include "nacre/bind/alpha_shadow.glsl"

out vec4 color;

void main() {
    float alpha = texelFetch(nacre_alpha_map, ivec2(gl_FragCoord.xy), 0).a;
    color = vec4(0.0, 0.0, 0.0, clamp(alpha * nacre_alpha_scale, 0.0, 1.0));
}
