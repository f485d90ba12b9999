// Lit surface, addressed by texture matrices (HSE section 1.1, eq. 2 and 3): one directional light, orthographic
// camera. The texture coordinates are matrix products of the normal, or of the tangent for Banks' form.
#include "nacre/bind/model.glsl"
#include "nacre/bind/texture_matrix.glsl"
#include "nacre/bind/view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;

out vec4 v_cosines;  // cos theta_d, cos delta, cos alpha, cos beta
out vec2 v_tangent;  // t.l, t.v

void main() {
    vec3 n = nacre_mesh_normal(normal);
    vec3 t = nacre_mesh_tangent(tangent, n).xyz;
    v_cosines = vec4((nacre_matrix_half * vec4(n, 1.0)).xy, (nacre_matrix_light_view * vec4(n, 1.0)).xy);
    v_tangent = (nacre_matrix_light_view * vec4(t, 1.0)).xy;
    gl_Position = nacre_world_to_clip * vec4(nacre_mesh_position(position), 1.0);
}
