// A background of one colour behind a virtual viewpoint. Drawn by sky.vert.glsl.
#include "nacre/bind/background.glsl"
#include "nacre/bind/view.glsl"

#ifdef NACRE_VIEW
in vec4 v_far;
#endif

out vec4 color;

void main() {
    vec3 sum = nacre_background;
#ifdef NACRE_VIEW
    sum = nacre_view_background(sum, v_far);
#endif
    color = vec4(sum, 1.0);
}
