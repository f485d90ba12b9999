// Average of a shadow's levels over (2 NACRE_FILTER_RADIUS + 1)^2 pixels, in HYBRID section 4.1 7 x 7. With
// NACRE_EDGE_STOPPING 1 of pixels of the same object, no farther from the plane of its surface than a tenth of their
// distance, whose level is within 1.5 steps of the middle one's.
#include "nacre/bind/counted.glsl"
#include "nacre/bind/geometry.glsl"

out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(nacre_counted_image, 0) - 1;
    vec4 place = texelFetch(nacre_geometry_place, at, 0);
    vec3 n = texelFetch(nacre_geometry_normal, at, 0).xyz;
    float middle = texelFetch(nacre_counted_image, at, 0).x;
    float sum = 0.0;
    float weights = 0.0;
    for (int j = -NACRE_FILTER_RADIUS; j <= NACRE_FILTER_RADIUS; ++j)
        for (int i = -NACRE_FILTER_RADIUS; i <= NACRE_FILTER_RADIUS; ++i) {
            ivec2 there = clamp(at + ivec2(i, j), ivec2(0), last);
            float level = texelFetch(nacre_counted_image, there, 0).x;
            float weight = 1.0;
#if NACRE_EDGE_STOPPING
            vec4 other = texelFetch(nacre_geometry_place, there, 0);
            vec3 offset = other.xyz - place.xyz;
            if (other.w != place.w || abs(dot(n, offset)) > 0.1 * length(offset)) weight = 0.0;
            if (abs(level - middle) > 1.5 * nacre_counted_value) weight = 0.0;
#endif
            sum += weight * level;
            weights += weight;
        }
    color = vec4(sum / weights);
}
