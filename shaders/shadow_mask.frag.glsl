// The share of one light that shadows leave, alone.
#include "nacre/bind/shadows.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/light.glsl"

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;

out vec4 color;

void main() {
    vec3 normal = nacre_shadow_normal(v_position, nacre_direction_to(nacre_eye, v_position));
    color = vec4(vec3(nacre_shadow_lit(0, v_position, normal)), 1.0);
}
