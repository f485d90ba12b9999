// The surrounding as a background: one triangle at the far plane, and the direction in which each pixel looks.
#include "nacre/bind/sky.glsl"

out vec3 v_direction;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    vec4 near = nacre_clip_to_world * vec4(corner, -1.0, 1.0);
    vec4 far = nacre_clip_to_world * vec4(corner, 1.0, 1.0);
    v_direction = far.xyz / far.w - near.xyz / near.w;
    gl_Position = vec4(corner, 1.0, 1.0);
}
