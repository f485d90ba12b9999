// A shadow volume's points (ShadowVolume, shading/multipass/shadow_volume.hpp). Near ones get the very depth that
// lit.vert.glsl gives the mesh's vertices. #define NACRE_STENCIL_BEYOND_FAR: what is beyond the far plane alone (Mesa 22
// clips by a distance that is written, enabled or not). NACRE_STENCIL_BEYOND_NEAR: beyond the near plane. Desktop OpenGL.
#include "nacre/bind/model.glsl"
#include "nacre/bind/stencil_volume.glsl"
#include "nacre/bind/view.glsl"

layout(location = 0) in vec4 point;  // w = 1: swept

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
}
