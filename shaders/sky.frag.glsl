// The surrounding as a background: the reflection's map, looked up with the viewing direction.
#include "nacre/bind/environment.glsl"
#include "nacre/bind/view.glsl"

in vec3 v_direction;
#ifdef NACRE_VIEW
in vec4 v_far;
#endif

out vec4 color;

void main() {
    vec3 d = nacre_env_from_world * normalize(v_direction);
    vec3 sum = nacre_env_reflection_color * NACRE_ENV_REFLECTED(d);
#ifdef NACRE_VIEW
    sum = nacre_view_background(sum, v_far);
#endif
    color = vec4(sum, 1.0);
}
