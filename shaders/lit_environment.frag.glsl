// Lamps by a BRDF, factored or evaluated, and the surrounding by prefiltered maps, in one shader.
#include "nacre/bind/environment.glsl"
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
    vec3 surrounding = nacre_env_radiance(to_eye, point.frame[2], point.visibility);
    color = vec4(nacre_ambient * point.visibility + surrounding + nacre_lamps(point, to_eye, v_position), 1.0);
}
