// A mesh whose vertices bring their exitant radiance (HEMI equation 2).
#include "nacre/bind/view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 radiance;

out vec3 v_radiance;

void main() {
    v_radiance = radiance;
    gl_Position = nacre_world_to_clip * vec4(position, 1.0);
}
