// An element's number for each pixel that shows it. C++: ItemBuffer (shading/hybrid/item_buffer.hpp).
#include "nacre/bind/item_buffer.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uint item;

flat out uint v_item;

void main() {
    v_item = item;
    gl_Position = nacre_item_to_clip * vec4(position, 1.0);
}
