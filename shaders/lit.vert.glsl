// Lit surface, addressed per pixel: hands normal, tangent and uv on.
#include "nacre/bind/model.glsl"
#include "nacre/bind/view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;

out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;
#ifdef NACRE_VIEW
invariant gl_Position;  // passes meet at equal depths
#endif

void main() {
    v_position = nacre_mesh_position(position);
    v_normal = nacre_mesh_normal(normal);
    v_tangent = nacre_mesh_tangent(tangent, v_normal);
    v_uv = uv;
    gl_Position = nacre_world_to_clip * vec4(v_position, 1.0);
#ifdef NACRE_VIEW
    gl_ClipDistance[0] = dot(nacre_view_clip, vec4(v_position, 1.0));
#endif
}
