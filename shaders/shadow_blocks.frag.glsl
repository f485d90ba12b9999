// A layer's depths, stored for the lookup.
#include "nacre/bind/shadow_map.glsl"
#include "nacre/shadow.glsl"

out uvec4 color;

void main() {
    ivec2 at = 2 * ivec2(gl_FragCoord.xy);
    vec4 depth = vec4(texelFetch(nacre_shadow_depth, at, 0).r, texelFetch(nacre_shadow_depth, at + ivec2(1, 0), 0).r,
                      texelFetch(nacre_shadow_depth, at + ivec2(0, 1), 0).r,
                      texelFetch(nacre_shadow_depth, at + ivec2(1, 1), 0).r);
    color = nacre_shadow_encode(depth, nacre_shadow_bits);
}
