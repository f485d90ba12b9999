// Lit surface, addressed per vertex ("fast Phong", HSE section 1.1): local light and view vectors are made at the
// vertices and interpolated without normalising again.
#include "nacre/bind/lights.glsl"
#include "nacre/bind/model.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/frame.glsl"
#include "nacre/light.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;

out vec3 v_wo;
out vec4 v_light[4];  // wi, falloff
#ifdef NACRE_VIEW
out vec3 v_position;
invariant gl_Position;  // passes meet at equal depths
#endif

void main() {
    vec3 world = nacre_mesh_position(position), n = nacre_mesh_normal(normal);
    mat3 frame = nacre_frame(n, nacre_mesh_tangent(tangent, n));
    v_wo = nacre_to_local(frame, nacre_direction_to(nacre_eye, world));
    for (int i = 0; i < 4; ++i) {
        vec4 light = nacre_light_position[i];
        v_light[i] = vec4(0.0);
        vec3 to_light = nacre_direction_to(light, world);
        if (i < NACRE_LIGHT_COUNT)
            v_light[i] = vec4(nacre_to_local(frame, to_light), nacre_light_share(i, to_light, world));
    }
    gl_Position = nacre_world_to_clip * vec4(world, 1.0);
#ifdef NACRE_VIEW
    v_position = world;
    gl_ClipDistance[0] = dot(nacre_view_clip, vec4(world, 1.0));
#endif
}
