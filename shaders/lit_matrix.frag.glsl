// Lit surface, addressed by texture matrices: the interpolated products are the lookups' coordinates.
#include "nacre/bind/factored_brdf.glsl"
#include "nacre/bind/lights.glsl"

in vec4 v_cosines;
in vec2 v_tangent;

out vec4 color;

void main() {
    vec3 f = vec3(0.0);
    if (v_cosines.z > 0.0 && v_cosines.w > 0.0) f = nacre_factored_brdf_at(v_cosines, v_tangent);
    color = vec4(nacre_ambient + f * v_cosines.z * nacre_light_color[0], 1.0);
}
