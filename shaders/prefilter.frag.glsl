// One face of one level of a prefiltered cube.
#include "nacre/bind/prefilter.glsl"
#include "nacre/prefilter.glsl"

out vec4 color;

void main() {
    vec2 st = (2.0 * gl_FragCoord.xy - nacre_prefilter_size) / nacre_prefilter_size;  // 0 in the middle, exactly
    vec3 r = normalize(nacre_prefilter_destination * vec3(st, 1.0));
    ivec2 nearest = nacre_prefilter_texel(r, nacre_prefilter_edge >> nacre_prefilter_first);
    color = vec4(texelFetch(nacre_prefilter_strip, nearest, nacre_prefilter_first).rgb, 1.0);
#if NACRE_PREFILTER_LOBE != NACRE_PREFILTER_MIRROR
    vec4 p = nacre_prefilter_lobe_values;
    NacrePrefilterPlan plan = NacrePrefilterPlan(nacre_prefilter_edge, nacre_prefilter_first, nacre_prefilter_last,
                                                 p.x, p.y, p.z, p.w, nacre_prefilter_second, nacre_prefilter_axis);
    vec4 sum = nacre_prefilter_sum(nacre_prefilter_strip, plan, r, ivec4(nacre_prefilter_part));
    if (nacre_prefilter_goes_on > 0) sum += texelFetch(nacre_prefilter_before, ivec2(gl_FragCoord.xy), 0);
    if (sum.a > nacre_prefilter_unseen) color = vec4(sum.rgb / sum.a, 1.0);
    if (nacre_prefilter_ends == 0) color = sum;
#endif
}
