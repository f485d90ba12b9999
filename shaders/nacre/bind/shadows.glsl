// Shadow maps of the lights. Only what the program's #defines ask for is compiled in; a light without is never shadowed.
//   NACRE_SHADOWS      any
//   NACRE_SHADOW_i     light i's map (i = 0 to 7), a list of four: kind (NACRE_SHADOW_SPOT, ...), texels along the
//                      filter's edge, bits (16 or 32), cascades
// C++: ShadowMap (shading/shadow_map.hpp) sets defines and uniforms; shadowLit (core/shadow_view.hpp) is the twin.
#ifndef NACRE_BIND_SHADOWS_GLSL
#define NACRE_BIND_SHADOWS_GLSL

#include "nacre/shadow.glsl"

#ifdef NACRE_SHADOWS
uniform usampler2DArray nacre_shadow_map0;
uniform usampler2DArray nacre_shadow_map1;
uniform usampler2DArray nacre_shadow_map2;
uniform usampler2DArray nacre_shadow_map3;
uniform usampler2DArray nacre_shadow_map4;
uniform usampler2DArray nacre_shadow_map5;
uniform usampler2DArray nacre_shadow_map6;
uniform usampler2DArray nacre_shadow_map7;
uniform mat4 nacre_shadow_from_world[8];  // rigid
uniform vec4 nacre_shadow_range[8];       // depth of 0, that of 1 less that, resolution, the user's bias or -1
uniform vec4 nacre_shadow_size[8];        // texels along an edge, its inverse, scale in texels, its inverse
uniform vec4 nacre_shadow_cascades[32];   // four a light: texel coordinate = xy of light space * z + xy; w = 1 / z

bool nacre_shadow_within(vec2 at, float edge) { return abs(at.x) <= edge && abs(at.y) <= edge; }

float nacre_shadow_by(usampler2DArray map, int i, int kind, int n, int bits, int cascades, vec3 position, vec3 normal) {
    vec4 range = nacre_shadow_range[i];
    vec4 size = nacre_shadow_size[i];
    float middle = 0.5 * size.x;
    vec3 q = (nacre_shadow_from_world[i] * vec4(position, 1.0)).xyz;
    vec3 m = -(mat3(nacre_shadow_from_world[i]) * normal);
    int layer = 0;
    if (kind == NACRE_SHADOW_CUBE) layer = nacre_shadow_cube_layer(q);
    if (kind == NACRE_SHADOW_DUAL_PARABOLOID) layer = q.z < 0.0 ? 1 : 0;
    q = nacre_shadow_layer_frame(kind, layer, q);
    m = nacre_shadow_layer_frame(kind, layer, m);
    float height = dot(m, q);
    // 1 / z and cos^2 of the angle between normal and ray by one division
    float square = dot(q, q);
    float inverse = 1.0 / (q.z * square);
    float cos2 = height * height * (inverse * q.z);
    if (kind == NACRE_SHADOW_DIRECTIONAL) cos2 = m.z * m.z;
    if (kind == NACRE_SHADOW_DUAL_PARABOLOID) cos2 = height * height / square;  // q.z may be 0
    vec2 at;
    vec3 side = vec3(m.xy * size.w, m.z - dot(m.xy, vec2(middle * size.w)));
    float texel;
    float edge = middle - 0.5 * float(n);
    bool inside = true;
    if (kind == NACRE_SHADOW_DIRECTIONAL) {
        vec4 square = nacre_shadow_cascades[4 * i];
        at = q.xy * square.z + square.xy;
        inside = nacre_shadow_within(at - middle, edge);
        for (int k = 1; k < cascades; ++k) {
            vec4 next = nacre_shadow_cascades[4 * i + k];
            vec2 there = q.xy * next.z + next.xy;
            bool here = !inside && nacre_shadow_within(there - middle, edge);
            square = here ? next : square;
            at = here ? there : at;
            layer = here ? k : layer;
            inside = inside || here;
        }
        texel = square.w;
        side = vec3(m.xy * square.w, -dot(m.xy, square.xy) * square.w);
    } else if (kind == NACRE_SHADOW_DUAL_PARABOLOID) {
        float r = sqrt(square);
        vec2 p = q.xy / (r + q.z);
        at = p * size.z + middle;
        texel = r * 2.0 * size.w / (1.0 + dot(p, p));
    } else {
        at = q.xy * (size.z * (inverse * square)) + middle;
        texel = q.z * size.w;
        inside = q.z > 0.0 && nacre_shadow_within(at - middle, edge);
    }
    float bias = range.w >= 0.0 ? range.w : nacre_shadow_bias(n, texel, cos2, range.z);
    float lit = nacre_shadow_filter(map, layer, kind, n, bits, size, range.xy, at, m, side, height - bias);
    float facing = kind == NACRE_SHADOW_DIRECTIONAL ? m.z : height;
    return facing > 0.0 ? (inside ? lit : 1.0) : 0.0;
}
#endif

// Unit normal of the triangle, on the side that is looked at. Takes derivatives: outside of branches. to_eye: unit; it
// stands in where single precision can't tell neighbouring pixels' positions apart.
vec3 nacre_shadow_normal(vec3 position, vec3 to_eye) {
    vec3 n = cross(dFdx(position), dFdy(position)) + 1e-18 * to_eye;
    return n * (inversesqrt(dot(n, n)) * (dot(n, to_eye) < 0.0 ? -1.0 : 1.0));
}

// Share of light i that other surfaces let through to `position`; 0 behind the surface. normal: nacre_shadow_normal.
float nacre_shadow_lit(int i, vec3 position, vec3 normal) {
#ifdef NACRE_SHADOW_0
    if (i == 0) return nacre_shadow_by(nacre_shadow_map0, 0, NACRE_SHADOW_0, position, normal);
#endif
#ifdef NACRE_SHADOW_1
    if (i == 1) return nacre_shadow_by(nacre_shadow_map1, 1, NACRE_SHADOW_1, position, normal);
#endif
#ifdef NACRE_SHADOW_2
    if (i == 2) return nacre_shadow_by(nacre_shadow_map2, 2, NACRE_SHADOW_2, position, normal);
#endif
#ifdef NACRE_SHADOW_3
    if (i == 3) return nacre_shadow_by(nacre_shadow_map3, 3, NACRE_SHADOW_3, position, normal);
#endif
#ifdef NACRE_SHADOW_4
    if (i == 4) return nacre_shadow_by(nacre_shadow_map4, 4, NACRE_SHADOW_4, position, normal);
#endif
#ifdef NACRE_SHADOW_5
    if (i == 5) return nacre_shadow_by(nacre_shadow_map5, 5, NACRE_SHADOW_5, position, normal);
#endif
#ifdef NACRE_SHADOW_6
    if (i == 6) return nacre_shadow_by(nacre_shadow_map6, 6, NACRE_SHADOW_6, position, normal);
#endif
#ifdef NACRE_SHADOW_7
    if (i == 7) return nacre_shadow_by(nacre_shadow_map7, 7, NACRE_SHADOW_7, position, normal);
#endif
    return 1.0;
}

#endif
