// Point lights that stand for parts of surfaces, and their shadow maps (HYBRID section 3).
#ifndef NACRE_VIRTUAL_LIGHT_GLSL
#define NACRE_VIRTUAL_LIGHT_GLSL

#include "nacre/shadow.glsl"

#define NACRE_VIRTUAL_POINT 0
#define NACRE_VIRTUAL_DISK 1
#define NACRE_VIRTUAL_RECTANGLE 2

// An edge's part of Lambert's form factor, times 2 pi: a and b are the unit directions of its ends.
float nacre_virtual_edge(vec3 a, vec3 b, vec3 n) {
    vec3 across = cross(a, b);
    float sine = length(across);
    return sine > 0.0 ? atan(sine, dot(a, b)) * dot(across, n) / sine : 0.0;
}

// Irradiance [1/m^2] of a light with intensity cos(angle to its normal) at a place with normal n, or 0 behind either.
// offset: from the place to the light's middle; near: NACRE_VIRTUAL_...; disk: area / pi; u, v: the rectangle's half
// edges. x: that; y: as a point. C++: virtualLightGeometry (shading/hybrid/virtual_lights.hpp), to 1e-4.
vec2 nacre_virtual_light(int near, vec3 offset, vec3 n, vec3 light_normal, float disk, vec3 u, vec3 v) {
    float square = max(dot(offset, offset), 1e-12);
    float towards = -dot(light_normal, offset);
    float cosines = max(dot(n, offset), 0.0) * max(towards, 0.0) / square;
    float point = cosines / square;
    if (near == NACRE_VIRTUAL_POINT) return vec2(point);
    float light = cosines / (square + disk);
    if (near == NACRE_VIRTUAL_RECTANGLE && towards > 0.0 && square < 16.0 * (dot(u, u) + dot(v, v))) {
        vec3 a = normalize(offset - u - v);
        vec3 b = normalize(offset - u + v);
        vec3 c = normalize(offset + u + v);
        vec3 d = normalize(offset + u - v);
        float sum = nacre_virtual_edge(a, b, n) + nacre_virtual_edge(b, c, n) + nacre_virtual_edge(c, d, n);
        light = max(0.0, sum + nacre_virtual_edge(d, a, n)) / (6.2831853 * disk);
    }
    return vec2(light, point);
}

// A frame about a unit normal, orthonormal, for any normal (Duff et al. 2017). C++: virtualLightFrame, to 1e-6.
mat3 nacre_virtual_frame(vec3 n) {
    float s = n.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// 0 where the map has a surface above the receiver's plane, 1 elsewhere. q: the receiver in the light's frame; m: its
// normal there; drawn: near, 1 / (far - near), map coordinate of the horizon, texels along an edge, as the map was drawn.
float nacre_virtual_lit(sampler2DArray map, int layer, vec3 q, vec3 m, vec4 drawn) {
    float r = length(q);
    vec2 p = q.xy / (r + max(q.z, 0.0));
    vec2 texel = floor(clamp((p * drawn.z * 0.5 + 0.5) * drawn.w, vec2(0.0), vec2(drawn.w - 1.0))) + 0.5;
    float depth = textureLod(map, vec3(texel / drawn.w, float(layer)), 0.0).x;  // texelFetch checks bounds
    vec2 middle = (texel * (2.0 / drawn.w) - 1.0) / drawn.z;
    vec3 stored = nacre_shadow_paraboloid(middle) * (depth / drawn.y + drawn.x);
    float bias = 2.0 * r / (drawn.w * drawn.z);
    return depth < 1.0 && dot(m, stored - q) > bias ? 0.0 : 1.0;
}

#endif
