// Lit surface, addressed per vertex: looks the interpolated vectors up as they come.
#include "nacre/bind/brdf.glsl"
#include "nacre/bind/lights.glsl"

in vec3 v_wo;
in vec4 v_light[4];

out vec4 color;

void main() {
    vec3 sum = nacre_ambient;
    for (int i = 0; i < 4; ++i) {
        if (i >= NACRE_LIGHT_COUNT) break;
        vec3 wi = v_light[i].xyz;
        if (wi.z <= 0.0 || v_wo.z <= 0.0) continue;
        sum += nacre_brdf(wi, v_wo) * (wi.z * v_light[i].w) * nacre_light_color[i];
    }
    color = vec4(sum, 1.0);
}
