// A surface in its surrounding: prefiltered reflection, transmission and diffuse light.
#include "nacre/bind/environment.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/light.glsl"

in vec3 v_position;
in vec3 v_normal;

out vec4 color;

void main() { color = vec4(nacre_env_radiance(nacre_direction_to(nacre_eye, v_position), normalize(v_normal)), 1.0); }
