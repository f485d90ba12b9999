// Depth maps of lights: where a point falls into them, and percentage-closer filtering against the receiver's plane.
// The formulas and their derivations are core/shadow_view.hpp's; `kind`, `n` and numbers of cascades are literals.
#ifndef NACRE_SHADOW_GLSL
#define NACRE_SHADOW_GLSL

#define NACRE_SHADOW_SPOT 0
#define NACRE_SHADOW_DIRECTIONAL 1
#define NACRE_SHADOW_CUBE 2
#define NACRE_SHADOW_DUAL_PARABOLOID 3

// Linear depth in [0, 1] of a texel: 32 bits in red, or 16 in red and green. decode: (1, 0), or (65280, 255) / 65535.
float nacre_shadow_depth(sampler2DArray map, ivec3 texel, vec2 decode) { return dot(texelFetch(map, texel, 0).rg, decode); }

// The pair of codes / 255 that nacre_shadow_depth reads back. Round trip: tests/shading/shadow_map_test.cpp.
vec2 nacre_shadow_encode16(float depth) {
    float code = floor(depth * 65535.0 + 0.5);
    float high = floor(code / 256.0);
    return vec2(high, code - 256.0 * high) / 255.0;
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
// the light. map_at: map coordinate of the point; range: depth of 0, and of 1 less that.
// side: for a map coordinate c and a depth z, dot(m, x) is dot(side, (c, 1)) z (SPOT, CUBE) or dot(side, (c, 1)) +
// m.z z (DIRECTIONAL). C++: shadowLit.
float nacre_shadow_filter(sampler2DArray map, int layer, int kind, int n, vec2 decode, float size, vec2 range,
                          float scale, vec2 map_at, vec3 m, vec3 side, float plane) {
    vec2 texels = (map_at * 0.5 + 0.5) * size - (n % 2 == 0 ? 0.5 : 0.0);
    vec2 low = floor(texels);
    vec2 f = texels - low;
    vec2 first = low - float((n - 1) / 2);
    ivec2 corner = ivec2(first);
    int last = int(size) - 1;
    float sum = 0.0;
    for (int j = 0; j < n; ++j) {
        float row = n == 1 ? 1.0 : j == 0 ? 1.0 - f.y : j == n - 1 ? f.y : 1.0;
        float across = 0.0;
        for (int i = 0; i < n; ++i) {
            float weight = n == 1 ? 1.0 : i == 0 ? 1.0 - f.x : i == n - 1 ? f.x : 1.0;
            ivec2 at = clamp(corner + ivec2(i, j), ivec2(0), ivec2(last));
            float depth = nacre_shadow_depth(map, ivec3(at, layer), decode);
            float z = range.x + range.y * depth;
            vec2 c = (first + vec2(float(i), float(j)) + 0.5) * (2.0 / size) - 1.0;
            float point;
            if (kind == NACRE_SHADOW_DUAL_PARABOLOID)
                point = dot(m, nacre_shadow_paraboloid(c / scale)) * z;
            else if (kind == NACRE_SHADOW_DIRECTIONAL)
                point = dot(side, vec3(c, 1.0)) + m.z * z;
            else
                point = dot(side, vec3(c, 1.0)) * z;
            across += point >= plane || depth >= 0.999995 ? weight : 0.0;
        }
        sum += across * row;
    }
    float width = float(n == 1 ? 1 : n - 1);
    return sum / (width * width);
}

#endif
