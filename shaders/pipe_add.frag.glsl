// Adds another pipe's image, in some rows.
#include "nacre/bind/pipes.glsl"

out vec4 color;

void main() { color = texelFetch(nacre_pipe_image, ivec2(gl_FragCoord.xy) - ivec2(0, nacre_pipe_row), 0); }
