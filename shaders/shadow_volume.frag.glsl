// The surface in a volume as a light sees it, into the depth buffer: each texel's ray is followed, in the layer's light
// space. #define NACRE_SHADOW_PARABOLOID or NACRE_SHADOW_PARALLEL: the kind of rays; else they fan out from the light.
#include "nacre/bind/shadow_map.glsl"
#include "nacre/bind/volume.glsl"
#include "nacre/shadow.glsl"

void main() {
    float first = nacre_shadow_drawn.x, last = first + 1.0 / nacre_shadow_drawn.y;
    vec2 p = gl_FragCoord.xy * (2.0 / nacre_shadow_drawn.w) - 1.0;
#ifdef NACRE_SHADOW_PARALLEL
    vec2 at = (p - nacre_shadow_square.xy) / nacre_shadow_square.z;
    vec3 near = vec3(at, first), far = vec3(at, last);
#else
#ifdef NACRE_SHADOW_PARABOLOID
    vec3 ray = nacre_shadow_paraboloid(p / nacre_shadow_drawn.z);
#else
    vec3 ray = vec3(p / nacre_shadow_drawn.z, 1.0);
#endif
    vec3 near = first * ray, far = last * ray;
#endif
    float t = nacre_volume_sight(near, far);
    if (t > 1.0) discard;
    gl_FragDepth = t;  // depth is linear along the ray
}
