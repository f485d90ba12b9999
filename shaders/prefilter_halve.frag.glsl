// The strip's next coarser level.
#include "nacre/bind/prefilter.glsl"
#include "nacre/prefilter.glsl"

out vec4 color;

void main() { color = nacre_prefilter_halved(nacre_prefilter_strip, ivec2(gl_FragCoord.xy), nacre_prefilter_edge); }
