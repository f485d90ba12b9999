// Depth maps of lights: where a point falls into them, and percentage-closer filtering against the receiver's plane.
// The formulas and their derivations are core/shadow_view.hpp's; `kind`, `n` and numbers of cascades are literals.
#ifndef NACRE_SHADOW_GLSL
#define NACRE_SHADOW_GLSL

#define NACRE_SHADOW_SPOT 0
#define NACRE_SHADOW_DIRECTIONAL 1
#define NACRE_SHADOW_CUBE 2
#define NACRE_SHADOW_DUAL_PARABOLOID 3

// Depths are stored in columns: block (x, j) has rows 2 j to 2 j + 3 of column x, so that one fetch brings any three rows
// in a row, in a third of the time of three. Integers, which every OpenGL ES 3 renders to: codes k / 65535 of linear depth in [0, 1], or
// the bits of the distance as a float. Where nothing is stored depth is 1e6 (16 bits: code 65535), so that no plane is
// behind it. range: distance of depth 0, and of 1 less that. Round trip: tests/shading/shadow_map_test.cpp.
uvec4 nacre_shadow_encode(vec4 depth, vec2 range, int bits) {
    if (bits == 16) return uvec4(min(depth, 1.0) * 65535.0 + 0.5);
    return floatBitsToUint(range.x + range.y * (depth + 1e6 * step(1.0, depth)));
}

// Distances.
vec4 nacre_shadow_decode(uvec4 block, vec2 range, int bits) {
    if (bits == 32) return uintBitsToFloat(block);
    vec4 depth = vec4(block) * (1.0 / 65535.0);
    return range.x + range.y * (depth + 1e6 * step(0.999995, depth));
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

// How far above the receiver's plane a stored surface must be to shadow it. cos2: square of the cosine between the plane's
// normal and the ray. C++: shadowBias.
float nacre_shadow_bias(int n, float texel, float cos2, float resolution) {
    return float(n) * 0.70710678 * texel * (1.0 - 0.5 * cos2) + resolution;
}

// Share of the filter's texels whose stored surface point isn't above the plane dot(m, x) = plane; m points away from
// the light. at: texel coordinate of the point; range: depth of 0, and of 1 less that.
// side: for a texel coordinate c and a depth z, dot(m, x) is dot(side, (c, 1)) z (SPOT, CUBE) or dot(side, (c, 1)) +
// m.z z (DIRECTIONAL); size: texels along an edge, its inverse, -, and DUAL_PARABOLOID's map coordinate a texel.
// A texel's weight is its overlap with a box of n - 1 texels about the point. C++: shadowLit.
// Sampled at texel centres, clamped to the edge: texelFetch, which llvmpipe checks against the bounds, costs more.
float nacre_shadow_filter(usampler2DArray map, int layer, int kind, int n, int bits, vec4 size, vec2 range, vec2 at,
                          vec3 m, vec3 side, float plane) {
    vec2 low = at - 0.5 * float(n - 1);
    vec2 first = vec2(floor(low.x), 2.0 * floor(0.5 * low.y));
    vec2 f = low - first;
    bool odd = f.y >= 1.0;
    first += 0.5;  // centre of the first texel
    float start = dot(side, vec3(first, 1.0));
    float sum = 0.0;
    for (int j = 0; j < (n + 4) / 4; ++j) {
        vec4 rows = first.y + float(4 * j) + vec4(0.0, 1.0, 2.0, 3.0);
        vec4 wy = clamp(0.5 * float(n) - abs(rows - at.y), 0.0, 1.0);
        if (n == 1) wy = odd ? vec4(0.0, 1.0, 0.0, 0.0) : vec4(1.0, 0.0, 0.0, 0.0);
        // the same, sooner
        if (n == 3) wy = odd ? vec4(0.0, 2.0 - f.y, 1.0, f.y - 1.0) : vec4(1.0 - f.y, 1.0, f.y, 0.0);
        vec4 along = (start + float(4 * j) * side.y) + side.y * vec4(0.0, 1.0, 2.0, 3.0);
        for (int i = 0; i < n; ++i) {
            float wx = n == 1 ? 1.0 : i == 0 ? 1.0 - f.x : i == n - 1 ? f.x : 1.0;
            vec2 block = first + vec2(float(i), float(4 * j) + 0.5);  // its middle, in texels
            uvec4 stored = textureLod(map, vec3(block * size.y, float(layer)), 0.0);
            vec4 z = nacre_shadow_decode(stored, range, bits);
            vec4 point = along + float(i) * side.x;
            if (kind == NACRE_SHADOW_DIRECTIONAL)
                point += m.z * z;
            else
                point *= z;
            if (kind == NACRE_SHADOW_DUAL_PARABOLOID) {
                vec2 p = (first + vec2(float(i), float(4 * j)) - 0.5 * size.x) * size.w;
                point = vec4(dot(m, nacre_shadow_paraboloid(p)), dot(m, nacre_shadow_paraboloid(p + vec2(0.0, size.w))),
                             dot(m, nacre_shadow_paraboloid(p + vec2(0.0, 2.0 * size.w))),
                             dot(m, nacre_shadow_paraboloid(p + vec2(0.0, 3.0 * size.w)))) * z;
            }
            float column = (point.x >= plane ? wy.x : 0.0) + (point.y >= plane ? wy.y : 0.0);
            column += (point.z >= plane ? wy.z : 0.0) + (point.w >= plane ? wy.w : 0.0);
            sum += column * wx;
        }
    }
    float width = float(n == 1 ? 1 : n - 1);
    return sum * (1.0 / (width * width));
}

#endif
