// Lit surface, addressed per pixel: hands normal and tangent on.
#include "nacre/bind/view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;

out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;

void main() {
    v_position = position;
    v_normal = normal;
    v_tangent = tangent;
    gl_Position = nacre_world_to_clip * vec4(position, 1.0);
}
