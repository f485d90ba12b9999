// Adds a bit of the g-count.
#include "nacre/bind/counted.glsl"

out vec4 color;

void main() { color = vec4(nacre_counted_value); }
