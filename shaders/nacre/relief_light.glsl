// Light that bounces in a relief, passed on through its scatter map (HSE section 3.2, equation 10, figure 12): for each
// direction what a texel sees there, looked up in a texture of radiance. Textures of radiance hold 1 in alpha where there
// is a surface and 0 in holes. C++ twin: bump/scattered_light.cpp; tests/shading/relief_light_test.cpp says how near.
#ifndef NACRE_RELIEF_LIGHT_GLSL
#define NACRE_RELIEF_LIGHT_GLSL

const float kNacreReliefPi = 3.14159265;

// uv: not wrapped; the texture's own wrap continues the relief. Twin: Lookup.
vec3 nacre_relief_lookup(sampler2D radiance, vec2 uv) {
    vec4 v = textureLod(radiance, uv, 0.0);
    return v.a > 0.0 ? v.rgb / v.a : vec3(0.0);
}

// Distance [texels] along the plane to what texel sees in direction number k, < 0 for a miss, 0 for the own patch: four
// directions a layer. Twin: ScatterMap::distance, rounded to half.
float nacre_relief_distance(highp sampler2DArray distances, ivec2 texel, int k) {
    return texelFetch(distances, ivec3(texel, k / 4), 0)[k % 4];
}

// Texture coordinates of what is seen. towards: the direction's part along the plane, unit; 0 for vertical ones. Twin:
// seenPoint.
vec2 nacre_relief_seen(ivec2 texel, vec2 towards, float distance_along, vec2 size) {
    return (vec2(texel) + 0.5 + towards * distance_along) / size;
}

// Normal of patch q at a texel's centre. q: x 1 towards +x, y 1 towards +y. Twin: ownNormals.
vec3 nacre_relief_own(vec4 slopes, ivec2 q) {
    return normalize(vec3(q.x > 0 ? -slopes.y : -slopes.x, q.y > 0 ? -slopes.w : -slopes.z, 1.0));
}

// Place of a texel in a texture of (k + 1)^2 samples: corner, share of the patch. Twin: PatchSamples::of.
void nacre_relief_sample(ivec2 texel, int k, out vec2 corner, out vec2 share) {
    vec2 from = vec2(texel - (k + 1) / 2), each = vec2(k + 1);
    corner = floor((from + 0.5) / each);
    share = (from - corner * each) / float(k);
}

// In the texels of such a texture. Twin: PatchSamples::coordinate.
vec2 nacre_relief_place(vec2 corner, vec2 share, int k) {
    return float(k + 1) * corner + float((k + 1) / 2) + 0.5 + float(k) * share;
}

// Columns: x along the relief's x, y, normal. Twin: frameOf.
mat3 nacre_relief_frame(vec3 n) {
    vec3 t = vec3(1.0, 0.0, 0.0) - n * n.x;
    t = dot(t, t) > 1e-12 ? normalize(t) : vec3(0.0, 1.0, 0.0);
    return mat3(t, cross(n, t), n);
}

// A viewer behind the smoothed normal looks from a cosine of 0.1 above it. Twin: kGrazing of reflected.
vec3 nacre_relief_raise(vec3 n, vec3 wo) { return normalize(wo + n * max(0.0, 0.1 - dot(n, wo))); }

#endif
