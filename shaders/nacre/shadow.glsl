// Depth maps of lights: where a point falls into them, and percentage-closer filtering against the receiver's plane.
// The formulas and their derivations are core/shadow_view.hpp's; `kind`, `n` and numbers of cascades are literals.
#ifndef NACRE_SHADOW_GLSL
#define NACRE_SHADOW_GLSL

#define NACRE_SHADOW_SPOT 0
#define NACRE_SHADOW_DIRECTIONAL 1
#define NACRE_SHADOW_CUBE 2
#define NACRE_SHADOW_DUAL_PARABOLOID 3

// Depths are stored in blocks of 2 x 2 texels: (0, 0), (1, 0), (0, 1), (1, 1) of the block. One fetch for four texels
// takes half the time of four. Integers, which every OpenGL ES 3 renders to: codes of 16 bits, or the bits of a float.
// Where nothing is stored the depth is 1e6 (16 bits: code 65535), so that no plane is behind it.
uvec4 nacre_shadow_encode(vec4 depth, int bits) {
    return bits == 16 ? uvec4(min(depth, 1.0) * 65535.0 + 0.5) : floatBitsToUint(depth + 1e6 * step(1.0, depth));
}

// Round trip: tests/shading/shadow_map_test.cpp.
vec4 nacre_shadow_decode(uvec4 block, int bits) {
    if (bits == 32) return uintBitsToFloat(block);
    vec4 depth = vec4(block) * (1.0 / 65535.0);
    return depth + 1e6 * step(0.999995, depth);
}

// Face of a cube of maps: +X -X +Y -Y +Z -Z. C++: shadowPlace.
int nacre_shadow_cube_layer(vec3 q) {
    vec3 a = abs(q);
    if (a.x >= a.y && a.x >= a.z) return q.x > 0.0 ? 0 : 1;
    if (a.y >= a.z) return q.y > 0.0 ? 2 : 3;
    return q.z > 0.0 ? 4 : 5;
}

// C++: shadowLayerFrame, to single precision.
vec3 nacre_shadow_layer_frame(int kind, int layer, vec3 q) {
    if (kind == NACRE_SHADOW_DUAL_PARABOLOID) return layer == 0 ? q : vec3(-q.x, q.y, -q.z);
    if (kind != NACRE_SHADOW_CUBE) return q;
    if (layer == 0) return vec3(q.z, q.y, q.x);
    if (layer == 1) return vec3(-q.z, q.y, -q.x);
    if (layer == 2) return vec3(q.x, q.z, q.y);
    if (layer == 3) return vec3(q.x, -q.z, -q.y);
    if (layer == 4) return vec3(-q.x, q.y, q.z);
    return vec3(q.x, q.y, -q.z);
}

// Direction of map coordinate p (the horizon at length 1) of a paraboloid, unit.
vec3 nacre_shadow_paraboloid(vec2 p) {
    float s = dot(p, p);
    return vec3(2.0 * p, 1.0 - s) / (1.0 + s);
}

// How far above the receiver's plane a stored surface must be to shadow it. C++: shadowBias.
float nacre_shadow_bias(int n, float texel, float cos_theta, float resolution) {
    float h = float(n) * 0.70710678 * texel;
    return h * (sqrt(max(1.0 - cos_theta * cos_theta, 0.0)) + 0.5 * cos_theta) + resolution * cos_theta;
}

// Share of the filter's texels whose stored surface point isn't above the plane dot(m, x) = plane; m points away from
// the light. at: texel coordinate of the point; range: depth of 0, and of 1 less that.
// side: for a texel coordinate c and a depth z, dot(m, x) is dot(side, (c, 1)) z (SPOT, CUBE) or dot(side, (c, 1)) +
// m.z z (DIRECTIONAL); unit: DUAL_PARABOLOID's map coordinate a texel. size: texels along an edge.
// A texel's weight is its overlap with a box of n - 1 texels about the point. C++: shadowLit.
float nacre_shadow_filter(usampler2DArray map, int layer, int kind, int n, int bits, float size, vec2 range, float unit,
                          vec2 at, vec3 m, vec3 side, float plane) {
    // The filter's texels are within the map; what is clamped is a last block without one of them.
    vec2 block = clamp(floor((at - 0.5 * float(n - 1)) * 0.5), 0.0, 0.5 * size - float((n + 2) / 2));
    ivec2 corner = ivec2(block);
    vec2 first = block * 2.0 + 0.5;  // centre of the first texel
    float start = dot(side, vec3(first, 1.0));
    vec4 within = vec4(0.0, side.x, side.y, side.x + side.y);
    float sum = 0.0;
    for (int j = 0; j < (n + 2) / 2; ++j) {
        vec2 y = abs(first.y - at.y + vec2(0.0, 1.0) + float(2 * j));
        vec2 wy = n == 1 ? step(y, vec2(0.5)) : clamp(0.5 * float(n) - y, 0.0, 1.0);
        for (int i = 0; i < (n + 2) / 2; ++i) {
            vec2 x = abs(first.x - at.x + vec2(0.0, 1.0) + float(2 * i));
            vec2 wx = n == 1 ? step(x, vec2(0.5)) : clamp(0.5 * float(n) - x, 0.0, 1.0);
            uvec4 stored = texelFetch(map, ivec3(corner + ivec2(i, j), layer), 0);
            vec4 z = range.x + range.y * nacre_shadow_decode(stored, bits);
            vec4 point = within + (start + float(2 * i) * side.x + float(2 * j) * side.y);
            if (kind == NACRE_SHADOW_DIRECTIONAL)
                point += m.z * z;
            else
                point *= z;
            if (kind == NACRE_SHADOW_DUAL_PARABOLOID) {
                vec2 p = (first + vec2(float(2 * i), float(2 * j)) - 0.5 * size) * unit;
                point = vec4(dot(m, nacre_shadow_paraboloid(p)), dot(m, nacre_shadow_paraboloid(p + vec2(unit, 0.0))),
                             dot(m, nacre_shadow_paraboloid(p + vec2(0.0, unit))),
                             dot(m, nacre_shadow_paraboloid(p + unit))) * z;
            }
            vec4 lit = step(plane, point);
            sum += dot(lit.xy, wx) * wy.x + dot(lit.zw, wx) * wy.y;
        }
    }
    float width = float(n == 1 ? 1 : n - 1);
    return sum * (1.0 / (width * width));
}

#endif
