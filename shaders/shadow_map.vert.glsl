// A caster as a light sees it. #define NACRE_SHADOW_PARABOLOID: a hemisphere as one map (Brabec, Annen, Seidel 2002).
#include "nacre/bind/shadow_map.glsl"

layout(location = 0) in vec3 position;

out vec3 v_place;

void main() {
    v_place = (nacre_shadow_from_mesh * vec4(position, 1.0)).xyz;
#ifdef NACRE_SHADOW_PARABOLOID
    // What lies near the back pole goes far outside of the map; which side it comes in from again, the fragments check.
    float r = length(v_place);
    vec2 p = v_place.xy / max(r + v_place.z, 1e-3 * r + 1e-30);
    gl_Position = vec4(p * nacre_shadow_drawn.z, 0.0, 1.0);
#else
    gl_Position = nacre_shadow_to_clip * vec4(v_place, 1.0);
#endif
}
