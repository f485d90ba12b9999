// Lit surface, addressed per vertex: looks the interpolated vectors up as they come.
#include "nacre/bind/brdf.glsl"
#include "nacre/bind/lights.glsl"
#include "nacre/bind/view.glsl"

in vec3 v_wo;
in vec4 v_light[4];
#ifdef NACRE_VIEW
in vec3 v_position;
#endif

out vec4 color;

void main() {
    vec3 sum = nacre_ambient;
    for (int i = 0; i < 4; ++i) {
        if (i >= NACRE_LIGHT_COUNT) break;
        vec3 wi = v_light[i].xyz;
        if (wi.z <= 0.0 || v_wo.z <= 0.0) continue;
        sum += nacre_brdf(wi, v_wo) * (wi.z * v_light[i].w) * nacre_light_color[i];
    }
#ifdef NACRE_VIEW
    sum = nacre_view_seen(sum, v_position);
#endif
    color = vec4(sum, 1.0);
}
