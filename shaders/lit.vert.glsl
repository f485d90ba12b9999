// Lit surface, addressed per pixel: hands normal, tangent and uv on, with #define NACRE_VERTEX_RADIANCE a vertex's own
// radiance too.
#include "nacre/bind/model.glsl"
#include "nacre/bind/view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;

#ifdef NACRE_VERTEX_RADIANCE
layout(location = 4) in vec3 radiance;
out vec3 v_radiance;
#endif

out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;
#ifdef NACRE_VIEW
invariant gl_Position;  // passes meet at equal depths
#endif

invariant gl_Position;  // shadow volumes and passes that add light find the same depth

void main() {
    v_position = nacre_mesh_position(position);
    v_normal = nacre_mesh_normal(normal);
    v_tangent = nacre_mesh_tangent(tangent, v_normal);
    v_uv = uv;
#ifdef NACRE_VERTEX_RADIANCE
    v_radiance = radiance;
#endif
    gl_Position = nacre_world_to_clip * vec4(v_position, 1.0);
#ifdef NACRE_VIEW
    gl_ClipDistance[0] = dot(nacre_view_clip, vec4(v_position, 1.0));
#endif
}
