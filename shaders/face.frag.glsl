// A specular face without light of its own: fog before it, and in alpha what share of specular light passes.
#include "nacre/bind/face.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/light.glsl"

in vec3 v_position;
in vec2 v_uv;

out vec4 color;

void main() {
#ifdef NACRE_FACE_STEPS
    float share = nacre_face_share(nacre_face_to_eye(v_position));
#else
    float share = nacre_face_share(nacre_direction_to(nacre_eye, v_position));
#endif
#ifdef NACRE_FACE_TEXTURE
    share *= 1.0 - nacre_face_surface * nacre_face_texel(v_uv).a;
#endif
#ifdef NACRE_VIEW
    color = vec4(nacre_view_seen(vec3(0.0), v_position), share * nacre_view_clear(v_position));
#else
    color = vec4(vec3(0.0), share);
#endif
}
