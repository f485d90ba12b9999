// The surrounding as a background: one triangle at the far plane, and the direction in which each pixel looks.
#include "nacre/bind/sky.glsl"
#include "nacre/bind/view.glsl"

out vec3 v_direction;
#ifdef NACRE_VIEW
out vec4 v_far;
#endif

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    // From the eye to the far plane, times the weight that makes it linear across the picture from any viewpoint.
    vec4 far = nacre_clip_to_world * vec4(corner, 1.0, 1.0);
    v_direction = far.xyz * nacre_eye.w - nacre_eye.xyz * far.w;
    gl_Position = vec4(corner, 1.0, 1.0);
#ifdef NACRE_VIEW
    v_far = far;
    gl_ClipDistance[0] = 1.0;
#endif
}
