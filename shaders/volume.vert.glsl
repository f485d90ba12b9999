// A volume: polygons across it, or, to march through it, one triangle over the viewport and the line of sight of each
// pixel.
#include "nacre/bind/view.glsl"
#ifdef NACRE_VOLUME_MARCH
#include "nacre/bind/sky.glsl"

// Homogeneous: that is what is linear across the picture from any viewpoint.
out vec4 v_near;
out vec4 v_far;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    v_near = nacre_clip_to_world * vec4(corner, -1.0, 1.0);
    v_far = nacre_clip_to_world * vec4(corner, 1.0, 1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
#ifdef NACRE_VIEW
    gl_ClipDistance[0] = 1.0;
#endif
}
#else
layout(location = 0) in vec3 position;

out vec3 v_position;

void main() {
    v_position = position;
    gl_Position = nacre_world_to_clip * vec4(position, 1.0);
#ifdef NACRE_VIEW
    gl_ClipDistance[0] = dot(nacre_view_clip, vec4(position, 1.0));
#endif
}
#endif
