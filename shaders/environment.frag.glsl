// A surface in its surrounding: prefiltered reflection, transmission and diffuse light.
#include "nacre/bind/bump.glsl"
#include "nacre/bind/environment.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/light.glsl"

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;

out vec4 color;

void main() {
    vec3 to_eye = nacre_direction_to(nacre_eye, v_position);
#ifdef NACRE_BUMP
    NacreBump point = nacre_bump_point(nacre_frame(v_normal, v_tangent), v_tangent.w, v_uv, to_eye);
    color = vec4(nacre_env_radiance(to_eye, point.frame[2], point.visibility), 1.0);
#else
    color = vec4(nacre_env_radiance(to_eye, normalize(v_normal), 1.0), 1.0);
#endif
}
