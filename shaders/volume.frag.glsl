// The surface in a volume: light of lamps (#define NACRE_SCENE_LAMPS) and of the surrounding (NACRE_SCENE_SURROUNDING).
// Slices: what of the polygon is inside, as an alpha test keeps it; the depth is the polygon's. Marched: the first
// crossing of the line of sight, with its own depth.
#include "nacre/bind/bump.glsl"
#include "nacre/bind/lights.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/bind/volume.glsl"
#include "nacre/frame.glsl"
#include "nacre/light.glsl"
#ifdef NACRE_SCENE_LAMPS
#include "nacre/bind/lamps.glsl"
#endif
#ifdef NACRE_SCENE_SURROUNDING
#include "nacre/bind/environment.glsl"
#endif

#ifdef NACRE_VOLUME_MARCH
in vec4 v_near;
in vec4 v_far;
#else
in vec3 v_position;
#endif

out vec4 color;

void main() {
#ifdef NACRE_VOLUME_MARCH
    vec3 near = v_near.xyz / v_near.w;
    vec3 far = v_far.xyz / v_far.w;
#ifdef NACRE_VIEW
    float before = dot(nacre_view_clip, vec4(near, 1.0));  // on from the plane that clips meshes
    if (before < 0.0) near = mix(near, far, clamp(before / (before - dot(nacre_view_clip, vec4(far, 1.0))), 0.0, 1.0));
#endif
    float t = nacre_volume_sight(near, far);
    vec3 position = mix(near, far, min(t, 1.0));
    vec4 clip = nacre_world_to_clip * vec4(position, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
    bool kept = t <= 1.0;
    float lift = 0.0;
#else
    vec3 position = v_position;
    bool kept = nacre_volume_inside(position);
    float lift = 0.5 * nacre_volume_step;  // a slice is so far inside on average
#endif
    vec3 to_eye = nacre_direction_to(nacre_eye, position);
    vec3 outward = nacre_volume_outward(position, to_eye);
    mat3 frame = nacre_frame(outward, vec4(0.0, 0.0, 0.0, 1.0));
    NacreBump point = nacre_bump_point(frame, 1.0, vec2(0.0), to_eye);
    vec3 sum = nacre_ambient;
#ifdef NACRE_SCENE_LAMPS
    // Derivatives know the triangle that stands for the surface, the field's gradient its normal.
    sum += nacre_lamps_by(point, to_eye, position, position + lift * outward, outward);
#endif
#ifdef NACRE_SCENE_SURROUNDING
    sum += nacre_env_radiance(to_eye, outward, 1.0);
#endif
#ifdef NACRE_VIEW
    sum = nacre_view_seen(sum, position);
#endif
    color = vec4(sum, 1.0);
    if (!kept) discard;
}
