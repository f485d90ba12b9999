// Adds to the shadow's levels where a light's point doesn't reach.
#include "nacre/bind/counted.glsl"

out vec4 color;

void main() {
    float count = texelFetch(nacre_counted_image, ivec2(gl_FragCoord.xy), 0).x;
    color = vec4(count > 0.5 ? nacre_counted_value : 0.0);
}
