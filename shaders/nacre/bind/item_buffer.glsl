// Where an item buffer is seen from. C++: ItemBuffer (shading/hybrid/item_buffer.hpp).
#ifndef NACRE_BIND_ITEM_BUFFER_GLSL
#define NACRE_BIND_ITEM_BUFFER_GLSL

uniform mat4 nacre_item_to_clip;

#endif
