// Lit surface, addressed per pixel, with a relief or without.
#include "nacre/bind/lamps.glsl"
#include "nacre/bind/view.glsl"

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;

out vec4 color;

void main() {
    vec3 to_eye = nacre_direction_to(nacre_eye, v_position);
    NacreBump point = nacre_bump_point(nacre_frame(v_normal, v_tangent), v_tangent.w, v_uv, to_eye);
    color = vec4(nacre_ambient * point.visibility + nacre_lamps(point, to_eye, v_position), 1.0);
}
