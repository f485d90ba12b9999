// Casters as a point of a light sees them in one face of the cube around it.
#include "nacre/bind/point_maps.glsl"

layout(location = 0) in vec3 position;

void main() { gl_Position = nacre_point_to_clip * vec4(position, 1.0); }
