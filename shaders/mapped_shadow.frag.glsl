// Adds to the shadow's levels, for each of a light's NACRE_POINTS points that doesn't reach the pixel's surface or is
// behind it, an equal share of 1.
#include "nacre/bind/geometry.glsl"
#include "nacre/bind/point_maps.glsl"

out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 place = texelFetch(nacre_geometry_place, at, 0);
    vec3 n = nacre_geometry_unpacked(texelFetch(nacre_geometry_albedo, at, 0).w);
    float half_size = 0.5 * float(nacre_point_size);
    float level = 0.0;
    for (int i = 0; i < NACRE_POINTS; ++i) {
        vec3 from = place.xyz - nacre_point_places[i].xyz;
        vec3 a = abs(from);
        vec3 v = from + n * (nacre_point_depth.w * max(max(a.x, a.y), a.z));
        int axis = nacre_point_axis(v);
        vec3 there = nacre_point_turned(v, axis);
        vec3 normal = nacre_point_turned(n, axis);
        float side = there.z < 0.0 ? -1.0 : 1.0;
        there.z *= side;
        normal.z *= side;
        ivec2 texel = clamp(ivec2(there.xy * (half_size / there.z) + half_size), ivec2(0), ivec2(nacre_point_size - 1));
        // The surface's plane along the ray of the texel's middle, as the map would hold it.
        vec3 ray = vec3((vec2(texel) + 0.5) / half_size - 1.0, 1.0);
        float depth = clamp(dot(normal, there) / min(dot(normal, ray), -1e-6), 0.8 * there.z, 1.25 * there.z);
        int column = 2 * axis + (side < 0.0 ? 1 : 0);
        float drawn = texelFetch(nacre_point_maps, texel + nacre_point_size * ivec2(column, i), 0).x;
        bool behind = drawn < nacre_point_depth.x - nacre_point_depth.y / max(depth, nacre_point_depth.z);
        level += behind || dot(n, from) >= 0.0 ? 1.0 : 0.0;
    }
    color = vec4(place.w == 0.0 ? 0.0 : level / float(NACRE_POINTS));
}
