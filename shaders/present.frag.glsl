// A linear picture as the window shows it. C++: toneMap (shading/image_output.hpp).
#include "nacre/bind/present.glsl"
#include "nacre/tone.glsl"

out vec4 color;

void main() {
    vec2 at = nacre_present_area.xy + nacre_present_area.zw * gl_FragCoord.xy;
    color = vec4(nacre_srgb_encode(texture(nacre_present_picture, at).rgb / nacre_present_white), 1.0);
}
