// Lamps by a BRDF, factored or evaluated, and the surrounding by prefiltered maps, in one shader.
#include "nacre/bind/brdf.glsl"
#include "nacre/bind/environment.glsl"
#include "nacre/bind/lights.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/frame.glsl"
#include "nacre/light.glsl"

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;

out vec4 color;

void main() {
    mat3 frame = nacre_frame(v_normal, v_tangent);
    vec3 to_eye = nacre_direction_to(nacre_eye, v_position);
    vec3 wo = nacre_to_local(frame, to_eye);
    vec3 sum = nacre_ambient + nacre_env_radiance(to_eye, frame[2]);
    for (int i = 0; i < NACRE_LIGHT_COUNT; ++i) {
        vec4 light = nacre_light_position[i];
        vec3 wi = nacre_to_local(frame, nacre_direction_to(light, v_position));
        if (wi.z <= 0.0 || wo.z <= 0.0) continue;
        sum += nacre_brdf(wi, wo) * (wi.z * nacre_light_falloff(light, v_position)) * nacre_light_color[i];
    }
    color = vec4(sum, 1.0);
}
