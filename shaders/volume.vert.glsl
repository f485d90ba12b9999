// A volume: polygons across it, or, to march through it, one triangle over the viewport and the line of sight of each
// pixel.
#ifdef NACRE_VOLUME_MARCH
#include "nacre/bind/sky.glsl"

out vec3 v_near;
out vec3 v_far;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    vec4 near = nacre_clip_to_world * vec4(corner, -1.0, 1.0);
    vec4 far = nacre_clip_to_world * vec4(corner, 1.0, 1.0);
    v_near = near.xyz / near.w;
    v_far = far.xyz / far.w;
    gl_Position = vec4(corner, 0.0, 1.0);
}
#else
#include "nacre/bind/view.glsl"

layout(location = 0) in vec3 position;

out vec3 v_position;

void main() {
    v_position = position;
    gl_Position = nacre_world_to_clip * vec4(position, 1.0);
}
#endif
