// The surface in a volume, lit by lamps. Slices: what of the polygon is inside, as an alpha test keeps it; the depth is
// the polygon's. Marched: the first crossing of the line of sight, with its own depth.
#include "nacre/bind/lamps.glsl"
#include "nacre/bind/view.glsl"
#include "nacre/bind/volume.glsl"

#ifdef NACRE_VOLUME_MARCH
in vec3 v_near;
in vec3 v_far;
#else
in vec3 v_position;
#endif

out vec4 color;

void main() {
#ifdef NACRE_VOLUME_MARCH
    float t = nacre_volume_sight(v_near, v_far);
    vec3 position = mix(v_near, v_far, min(t, 1.0));
    vec4 clip = nacre_world_to_clip * vec4(position, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
    bool kept = t <= 1.0;
#else
    vec3 position = v_position;
    bool kept = nacre_volume_inside(position);
#endif
    vec3 to_eye = nacre_direction_to(nacre_eye, position);
    mat3 frame = nacre_frame(nacre_volume_outward(position, to_eye), vec4(0.0, 0.0, 0.0, 1.0));
    NacreBump point = nacre_bump_point(frame, 1.0, vec2(0.0), to_eye);
    color = vec4(nacre_ambient + nacre_lamps(point, to_eye, position), 1.0);
    if (!kept) discard;
}
