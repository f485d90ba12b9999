// Automatic texture coordinates: depth from the light, and the place in its map. #define NACRE_ALPHA_FROM_LIGHT: the
// picture is the light's.
#include "nacre/bind/alpha_shadow.glsl"
#include "nacre/bind/model.glsl"
#include "nacre/bind/view.glsl"

layout(location = 0) in vec3 position;

out float v_depth;
out vec4 v_place;

void main() {
    vec3 world = nacre_mesh_position(position);
    v_depth = dot(nacre_alpha_depth, vec4(world, 1.0));
    v_place = nacre_alpha_project * vec4(world, 1.0);
#ifdef NACRE_ALPHA_FROM_LIGHT
    gl_Position = nacre_alpha_light_clip * vec4(world, 1.0);
#else
    gl_Position = nacre_world_to_clip * vec4(world, 1.0);
#endif
}
