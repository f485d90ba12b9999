// Shadow maps of the lights. Only what the program's #defines ask for is compiled in; a light without is never shadowed.
//   NACRE_SHADOWS      any
//   NACRE_SHADOW_i     kind of light i's map: NACRE_SHADOW_SPOT, ... (i = 0 to 7)
//   NACRE_SHADOW_N_i   texels along the filter's edge
//   NACRE_SHADOW_C_i   cascades
// C++: ShadowMap (shading/shadow_map.hpp) sets defines and uniforms; shadowLit (core/shadow_view.hpp) is the twin.
#ifndef NACRE_BIND_SHADOWS_GLSL
#define NACRE_BIND_SHADOWS_GLSL

#include "nacre/shadow.glsl"

#ifdef NACRE_SHADOWS
uniform sampler2DArray nacre_shadow_map0;
uniform sampler2DArray nacre_shadow_map1;
uniform sampler2DArray nacre_shadow_map2;
uniform sampler2DArray nacre_shadow_map3;
uniform sampler2DArray nacre_shadow_map4;
uniform sampler2DArray nacre_shadow_map5;
uniform sampler2DArray nacre_shadow_map6;
uniform sampler2DArray nacre_shadow_map7;
uniform mat4 nacre_shadow_from_world[8];  // rigid
uniform vec4 nacre_shadow_range[8];       // depth of 0, that of 1 less that, resolution, the user's bias or -1
uniform vec4 nacre_shadow_size[8];        // texels along an edge, scale, decode of nacre_shadow_depth
uniform vec4 nacre_shadow_cascades[32];   // four a light: map coordinate = xy of light space * z + xy

float nacre_shadow_by(sampler2DArray map, int i, int kind, int n, int cascades, vec3 position, vec3 normal) {
    vec4 range = nacre_shadow_range[i];
    vec4 size = nacre_shadow_size[i];
    vec3 q = (nacre_shadow_from_world[i] * vec4(position, 1.0)).xyz;
    vec3 m = -(mat3(nacre_shadow_from_world[i]) * normal);
    int layer = 0;
    if (kind == NACRE_SHADOW_CUBE) layer = nacre_shadow_cube_layer(q);
    if (kind == NACRE_SHADOW_DUAL_PARABOLOID) layer = q.z < 0.0 ? 1 : 0;
    q = nacre_shadow_layer_frame(kind, layer, q);
    m = nacre_shadow_layer_frame(kind, layer, m);
    float height = dot(m, q);
    float cos_theta = kind == NACRE_SHADOW_DIRECTIONAL ? m.z : height * inversesqrt(dot(q, q));
    if (!(cos_theta > 0.0)) return 0.0;
    vec2 at = vec2(0.0);
    vec3 side = vec3(m.xy / size.y, m.z);
    float texel = 0.0;
    bool inside = true;
    float edge = 1.0 - float(n) / size.x;
    if (kind == NACRE_SHADOW_DIRECTIONAL) {
        vec4 square = vec4(0.0);
        inside = false;
        for (int k = 0; k < cascades; ++k) {
            vec4 next = nacre_shadow_cascades[4 * i + k];
            vec2 there = q.xy * next.z + next.xy;
            if (!inside && max(abs(there.x), abs(there.y)) <= edge) {
                inside = true;
                square = next;
                layer = k;
                at = there;
            }
        }
        texel = 2.0 / (square.z * size.x);
        side = vec3(m.xy / square.z, -dot(m.xy, square.xy) / square.z);
    } else if (kind == NACRE_SHADOW_DUAL_PARABOLOID) {
        float r = length(q);
        vec2 p = q.xy / (r + q.z);
        at = p * size.y;
        texel = r * 4.0 / (size.y * size.x * (1.0 + dot(p, p)));
    } else {
        at = q.xy / q.z * size.y;
        texel = q.z * 2.0 / (size.y * size.x);
        inside = q.z > 0.0 && max(abs(at.x), abs(at.y)) <= edge;
    }
    if (!inside) return 1.0;
    float bias = range.w >= 0.0 ? range.w : nacre_shadow_bias(n, texel, cos_theta, range.z);
    return nacre_shadow_filter(map, layer, kind, n, size.zw, size.x, range.xy, size.y, at, m, side, height - bias);
}
#endif

// Unit normal of the triangle, on the side that is looked at. Takes derivatives: outside of branches. to_eye: unit.
vec3 nacre_shadow_normal(vec3 position, vec3 to_eye) {
    vec3 n = cross(dFdx(position), dFdy(position));
    float size = length(n);
    n = size > 0.0 ? n / size : to_eye;
    return dot(n, to_eye) < 0.0 ? -n : n;
}

// Share of light i that other surfaces let through to `position`; 0 behind the surface. normal: nacre_shadow_normal.
float nacre_shadow_lit(int i, vec3 position, vec3 normal) {
#ifdef NACRE_SHADOW_0
    if (i == 0)
        return nacre_shadow_by(nacre_shadow_map0, 0, NACRE_SHADOW_0, NACRE_SHADOW_N_0, NACRE_SHADOW_C_0, position, normal);
#endif
#ifdef NACRE_SHADOW_1
    if (i == 1)
        return nacre_shadow_by(nacre_shadow_map1, 1, NACRE_SHADOW_1, NACRE_SHADOW_N_1, NACRE_SHADOW_C_1, position, normal);
#endif
#ifdef NACRE_SHADOW_2
    if (i == 2)
        return nacre_shadow_by(nacre_shadow_map2, 2, NACRE_SHADOW_2, NACRE_SHADOW_N_2, NACRE_SHADOW_C_2, position, normal);
#endif
#ifdef NACRE_SHADOW_3
    if (i == 3)
        return nacre_shadow_by(nacre_shadow_map3, 3, NACRE_SHADOW_3, NACRE_SHADOW_N_3, NACRE_SHADOW_C_3, position, normal);
#endif
#ifdef NACRE_SHADOW_4
    if (i == 4)
        return nacre_shadow_by(nacre_shadow_map4, 4, NACRE_SHADOW_4, NACRE_SHADOW_N_4, NACRE_SHADOW_C_4, position, normal);
#endif
#ifdef NACRE_SHADOW_5
    if (i == 5)
        return nacre_shadow_by(nacre_shadow_map5, 5, NACRE_SHADOW_5, NACRE_SHADOW_N_5, NACRE_SHADOW_C_5, position, normal);
#endif
#ifdef NACRE_SHADOW_6
    if (i == 6)
        return nacre_shadow_by(nacre_shadow_map6, 6, NACRE_SHADOW_6, NACRE_SHADOW_N_6, NACRE_SHADOW_C_6, position, normal);
#endif
#ifdef NACRE_SHADOW_7
    if (i == 7)
        return nacre_shadow_by(nacre_shadow_map7, 7, NACRE_SHADOW_7, NACRE_SHADOW_N_7, NACRE_SHADOW_C_7, position, normal);
#endif
    return 1.0;
}

#endif
