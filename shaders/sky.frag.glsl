// The surrounding as a background: the reflection's map, looked up with the viewing direction.
#include "nacre/bind/environment.glsl"

in vec3 v_direction;

out vec4 color;

void main() {
    vec3 d = nacre_env_from_world * normalize(v_direction);
    color = vec4(nacre_env_reflection_color * NACRE_ENV_REFLECTED(d), 1.0);
}
