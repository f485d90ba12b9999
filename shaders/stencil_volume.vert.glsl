// A shadow volume's points (ShadowVolume, shading/multipass/shadow_volume.hpp). Near ones get the very depth that
// lit.vert.glsl gives the mesh's vertices. Desktop OpenGL. One of, or none (Mesa 22 clips by a distance that is written,
// enabled or not):
//   NACRE_STENCIL_BEYOND_FAR  what is beyond the far plane alone
//   NACRE_STENCIL_BEYOND_NEAR  what is beyond the near plane
//   NACRE_VIEW                what is in front of a virtual viewpoint's clip plane, as lit.vert.glsl
// and NACRE_STENCIL_CUT: what is in front of the mesh's cuts.
#include "nacre/bind/model.glsl"
#include "nacre/bind/stencil_volume.glsl"
#include "nacre/bind/view.glsl"

layout(location = 0) in vec4 point;  // w = 1: swept

#ifdef NACRE_STENCIL_CUT
out vec2 v_before_cuts;
#endif

invariant gl_Position;

void main() {
    vec3 position = nacre_mesh_position(point.xyz);
    vec4 clip = nacre_world_to_clip * vec4(position, 1.0);
    if (point.w > 0.5) clip = nacre_world_to_clip * nacre_swept(position);
    gl_Position = clip;
#ifdef NACRE_STENCIL_BEYOND_FAR
    gl_ClipDistance[0] = clip.z - clip.w;
#endif
#ifdef NACRE_STENCIL_BEYOND_NEAR
    gl_ClipDistance[0] = clip.z + clip.w;
#endif
#ifdef NACRE_VIEW
    gl_ClipDistance[0] = dot(nacre_view_clip, vec4(position, 1.0));
#endif
#ifdef NACRE_STENCIL_CUT
    v_before_cuts = nacre_before_cuts(point.xyz);
#endif
}
