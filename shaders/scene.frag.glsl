// A surface of a scene: the parts that its material is made of, in one shader. The program's #defines choose them:
//   NACRE_SCENE_LAMPS        light of lamps by a BRDF (nacre/bind/lamps.glsl)
//   NACRE_VERTEX_RADIANCE    radiance that the vertices bring, added like ambient light
//   NACRE_SCENE_SURROUNDING  light of the surrounding (nacre/bind/environment.glsl)
//   NACRE_VIEW               from a virtual viewpoint (nacre/bind/view.glsl)
//   NACRE_FACE_TEXTURE       a texture over a specular face's own light (nacre/bind/face.glsl)
// and those of nacre/bind/bump.glsl its relief. Ambient light is always there. C++: shading/scene_programs.hpp.
#include "nacre/bind/bump.glsl"
#include "nacre/bind/lights.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/light.glsl"
#ifdef NACRE_SCENE_LAMPS
#include "nacre/bind/lamps.glsl"
#endif
#ifdef NACRE_SCENE_SURROUNDING
#include "nacre/bind/environment.glsl"
#endif
#ifdef NACRE_FACE_TEXTURE
#include "nacre/bind/face.glsl"
#endif

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;
#ifdef NACRE_VERTEX_RADIANCE
in vec3 v_radiance;
#endif

out vec4 color;

void main() {
    vec3 to_eye = nacre_direction_to(nacre_eye, v_position);
    NacreBump point = nacre_bump_point(nacre_frame(v_normal, v_tangent), v_tangent.w, v_uv, to_eye);
    vec3 sum = nacre_ambient * point.visibility;
#ifdef NACRE_VERTEX_RADIANCE
    sum += v_radiance * point.visibility;
#endif
#ifdef NACRE_SCENE_LAMPS
    sum += nacre_lamps(point, to_eye, v_position);
#endif
#ifdef NACRE_SCENE_SURROUNDING
    sum += nacre_env_radiance(to_eye, point.frame[2], point.visibility);
#endif
#ifdef NACRE_FACE_TEXTURE
    vec4 texel = nacre_face_texel(v_uv);
    sum *= texel.rgb * texel.a;
#endif
#ifdef NACRE_VIEW
    sum = nacre_view_seen(sum, v_position);
#endif
    color = vec4(sum, 1.0);
}
