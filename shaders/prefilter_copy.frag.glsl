// The surrounding's texels into the strip's level 0.
#include "nacre/bind/prefilter.glsl"
#include "nacre/prefilter.glsl"

out vec4 color;

void main() {
    vec3 d = nacre_prefilter_direction(ivec2(gl_FragCoord.xy), nacre_prefilter_edge);
    color = vec4(textureLod(nacre_prefilter_source, d, 0.0).rgb, nacre_prefilter_pack(vec2(0.5)));
}
