// A layer's depths, stored for the lookup.
#include "nacre/bind/shadow_map.glsl"
#include "nacre/shadow.glsl"

out uvec4 color;

void main() {
    int x = int(gl_FragCoord.x), y = 2 * int(gl_FragCoord.y), last = textureSize(nacre_shadow_depth, 0).y - 1;
    vec4 depth = vec4(texelFetch(nacre_shadow_depth, ivec2(x, y), 0).r,
                      texelFetch(nacre_shadow_depth, ivec2(x, y + 1), 0).r,
                      texelFetch(nacre_shadow_depth, ivec2(x, min(y + 2, last)), 0).r,
                      texelFetch(nacre_shadow_depth, ivec2(x, min(y + 3, last)), 0).r);
    color = nacre_shadow_encode(depth, nacre_shadow_stored, nacre_shadow_bits);
}
