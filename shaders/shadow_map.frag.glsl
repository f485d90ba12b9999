// Linear depth of a caster, into the depth buffer, which picks the nearest. #define NACRE_SHADOW_SLICES: the casters are
// slices of a volume, of which the inside casts; bind/volume.glsl then counts from the layer's light space.
#include "nacre/bind/shadow_map.glsl"
#ifdef NACRE_SHADOW_SLICES
#include "nacre/bind/volume.glsl"
#endif
#include "nacre/shadow.glsl"

in vec3 v_place;

void main() {
    float z = v_place.z;
#ifdef NACRE_SHADOW_SLICES
    if (!nacre_volume_inside(v_place)) discard;
#endif
#ifdef NACRE_SHADOW_PARABOLOID
    // Interpolated along straight edges, v_place is a point of the triangle but not the one that this texel sees. That
    // one is where the texel's ray meets the triangle's plane. Rays that miss the plane, or go 60 degrees past v_place,
    // are those of triangles about the back pole, whose outlines turn inside out.
    vec3 n = cross(dFdx(v_place), dFdy(v_place));
    vec2 p = (gl_FragCoord.xy * (2.0 / nacre_shadow_drawn.w) - 1.0) / nacre_shadow_drawn.z;
    vec3 ray = nacre_shadow_paraboloid(p);
    z = dot(n, v_place) / dot(n, ray);
    if (!(z > 0.0) || dot(ray, v_place) < 0.5 * length(v_place)) discard;
#endif
    float depth = (z - nacre_shadow_drawn.x) * nacre_shadow_drawn.y;
    if (depth < 0.0 || depth > 1.0) discard;
    gl_FragDepth = depth;
}
