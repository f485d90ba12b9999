// What lamps do to a point of a surface, with a relief or without.
#ifndef NACRE_BIND_LAMPS_GLSL
#define NACRE_BIND_LAMPS_GLSL

#include "nacre/bind/brdf.glsl"
#include "nacre/bind/bump.glsl"
#include "nacre/bind/light_levels.glsl"
#include "nacre/bind/lights.glsl"
#include "nacre/bind/shadows.glsl"
#include "nacre/frame.glsl"
#include "nacre/light.glsl"

// Sum over lights of f(wi, wo) cos(alpha) E, all vectors normalised in the pixel. to_eye: unit, world. shadow_position,
// shadow_normal: what nacre_shadow_lit is asked for.
vec3 nacre_lamps_by(NacreBump point, vec3 to_eye, vec3 position, vec3 shadow_position, vec3 shadow_normal) {
#ifdef NACRE_BUMP_ROUGHNESS
    nacre_brdf_added_alpha = point.alpha;
#endif
    vec3 wo = nacre_to_local(point.frame, to_eye);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < NACRE_LIGHT_COUNT; ++i) {
        vec4 light = nacre_light_position[i];
        vec3 to_light = nacre_direction_to(light, position);
        vec3 wi = nacre_to_local(point.frame, to_light);
        float lit = nacre_bump_lit(point, to_light);
        bool direct = wi.z > 0.0 && wo.z > 0.0 && lit > 0.0;
        bool indirect = false;
#ifdef NACRE_BUMP_INDIRECT
        indirect = i == NACRE_BUMP_INDIRECT && wo.z > 0.0 && dot(point.mesh[2], to_light) > 0.0;
#endif
        if (direct || indirect) {
            vec3 arrives = nacre_light_color[i] * nacre_light_share(i, to_light, position);
#ifdef NACRE_SHADOWS
            arrives *= nacre_shadow_lit(i, shadow_position, shadow_normal);
#endif
#ifdef NACRE_LIGHT_LEVELS
            arrives *= 1.0 - texelFetch(nacre_light_levels, ivec3(ivec2(gl_FragCoord.xy), i), 0).x;
#endif
            if (direct) sum += nacre_brdf(wi, wo) * (lit * wi.z) * arrives;
            if (indirect) sum += point.indirect * arrives;
        }
    }
    return sum;
}

// The same of a mesh. Takes derivatives: outside of branches.
vec3 nacre_lamps(NacreBump point, vec3 to_eye, vec3 position) {
#ifdef NACRE_SHADOWS
    return nacre_lamps_by(point, to_eye, position, position, nacre_shadow_normal(position, to_eye));
#else
    return nacre_lamps_by(point, to_eye, position, position, to_eye);
#endif
}

#endif
