// One step of light in a relief (shading/gpu_relief_light.hpp). NACRE_RELIEF_STEP chooses it.
#define NACRE_RELIEF_LEAVES 0
#define NACRE_RELIEF_SKY 1
#define NACRE_RELIEF_GATHER 2
#define NACRE_RELIEF_SEGMENT 3
#define NACRE_RELIEF_TOTAL 4

#include "nacre/bind/relief_light.glsl"
#include "nacre/relief_light.glsl"
#ifdef NACRE_RELIEF_BRDF
#include "nacre/bind/factored_brdf.glsl"
#endif

out vec4 color;

vec3 sky_radiance(int i) {
#ifdef NACRE_RELIEF_SKY_CUBE
    vec3 d = nacre_relief_to_sky * (nacre_relief_directions[i].xyz * vec3(nacre_relief_side, 1.0));
    return nacre_relief_sky_colors[i].rgb * textureLod(nacre_relief_sky_cube, d, 0.0).rgb;
#else
    return nacre_relief_sky_colors[i].rgb;
#endif
}

// f <n, wi>. Twin: reflected.
vec3 reflected(vec3 n, vec3 albedo, vec3 wi, vec3 wo) {
    float cosine = dot(n, wi);
    if (cosine <= 0.0) return vec3(0.0);
#ifdef NACRE_RELIEF_BRDF
    mat3 frame = nacre_relief_frame(n);
    return albedo * nacre_factored_brdf(wi * frame, nacre_relief_raise(n, wo) * frame) * cosine;
#else
    return albedo * (cosine / kNacreReliefPi);
#endif
}

// texel: of a period.
float lit_at_centre(ivec2 texel) {
    int each = nacre_relief_detail + 1;
    return texelFetch(nacre_relief_lit, texel * each + each / 2, 0).r;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
#if NACRE_RELIEF_STEP == NACRE_RELIEF_LEAVES
    vec3 fine = texelFetch(nacre_relief_fine, at, 0).xyz;
    float cosine = max(0.0, dot(fine, nacre_relief_light)) * texelFetch(nacre_relief_lit, at, 0).r;
    vec2 corner, share;
    nacre_relief_sample(at, nacre_relief_detail, corner, share);
    vec2 albedo_uv = (corner + 0.5 + share) / vec2(textureSize(nacre_relief_albedo, 0));
    vec2 passed_uv = nacre_relief_place(corner, share, 1) / vec2(textureSize(nacre_relief_passed_on, 0));
    vec3 direct =
        nacre_relief_lookup(nacre_relief_albedo, albedo_uv) * nacre_relief_irradiance * (cosine / kNacreReliefPi);
    color = fine == vec3(0.0) ? vec4(0.0) : vec4(direct + nacre_relief_lookup(nacre_relief_passed_on, passed_uv), 1.0);
#else
    ivec2 extent = textureSize(nacre_relief_normals, 0), q = at - at / 2 * 2;
    ivec2 texel = nacre_relief_patches == 1 ? at / 2 : at, twin = texel;
    vec2 size = vec2(extent), side = vec2(1.0);
    if (texel.x >= extent.x) twin.x = 2 * extent.x - 1 - texel.x, side.x = -1.0, q.x = 1 - q.x;
    if (texel.y >= extent.y) twin.y = 2 * extent.y - 1 - texel.y, side.y = -1.0, q.y = 1 - q.y;
    vec4 normal = texelFetch(nacre_relief_normals, twin, 0);
    color = vec4(0.0);
    if (normal.xyz == vec3(0.0)) return;
    vec4 slopes = texelFetch(nacre_relief_slopes, twin, 0);
    vec3 n = nacre_relief_patches == 1 ? nacre_relief_own(slopes, q) : normal.xyz;
    vec3 albedo = texelFetch(nacre_relief_albedo, twin, 0).rgb;
#endif

#if NACRE_RELIEF_STEP == NACRE_RELIEF_SKY
    vec4 sum = texelFetch(nacre_relief_before, at, 0);
    for (int i = 0; i < nacre_relief_count; ++i) {
        float w = nacre_relief_directions[i].w * max(0.0, dot(n, nacre_relief_directions[i].xyz));
        sum.a += w;
        if (nacre_relief_distance(nacre_relief_distances, twin, int(nacre_relief_towards[i].z)) < 0.0)
            sum.rgb += w * sky_radiance(i);
    }
    color = nacre_relief_last == 0 ? sum : vec4(sum.a > 0.0 ? albedo * sum.rgb / sum.a : vec3(0.0), 1.0);

#elif NACRE_RELIEF_STEP == NACRE_RELIEF_GATHER
    ivec2 list = nacre_relief_patches == 1 ? 2 * twin + q : twin;
    vec3 sum = vec3(0.0);
    vec2 leaves_size = vec2(textureSize(nacre_relief_leaves, 0)), centre = vec2(texel) + 0.5;
    for (int i = 0; i < nacre_relief_count; ++i) {
        vec4 two = texelFetch(nacre_relief_points, ivec3(list, i / 2), 0);
        vec2 p = centre - 0.5 + side * (i / 2 * 2 == i ? two.xy : two.zw), corner = floor(p);
        sum += nacre_relief_lookup(nacre_relief_leaves,
                                   nacre_relief_place(corner, p - corner, nacre_relief_detail) / leaves_size);
    }
    vec4 own = texelFetch(nacre_relief_own_shares, list, 0);
    int mine = nacre_relief_patches == 1 ? q.x + 2 * q.y : -1;
    sum *= (mine >= 0 ? own[mine] : normal.w) / float(max(1, nacre_relief_count));
    vec3 direct = albedo * nacre_relief_irradiance * (lit_at_centre(texel) / kNacreReliefPi);
    for (int k = 0; k < 4; ++k) {
        if (k == mine) continue;
        ivec2 other = ivec2(k - k / 2 * 2, k / 2);  // of the twin; in this tile, as its side says
        ivec2 here = ivec2(side.x > 0.0 ? other.x : 1 - other.x, side.y > 0.0 ? other.y : 1 - other.y);
        float cosine = max(0.0, dot(nacre_relief_own(slopes, other), nacre_relief_light * vec3(side, 1.0)));
        sum += own[k] * (direct * cosine + texelFetch(nacre_relief_passed_on, 2 * texel + here, 0).rgb);
    }
    color = vec4(albedo * sum + texelFetch(nacre_relief_sky, at, 0).rgb, 1.0);

#elif NACRE_RELIEF_STEP == NACRE_RELIEF_SEGMENT
    vec3 d = nacre_relief_directions[0].xyz;
    vec3 light = reflected(n, albedo, d, nacre_relief_to) * (nacre_relief_directions[0].w * nacre_relief_factor);
    if (light != vec3(0.0)) {
        vec2 towards = nacre_relief_towards[0].xy;
        float along = nacre_relief_distance(nacre_relief_distances, texel, int(nacre_relief_towards[0].z));
        light *= along < 0.0 ? sky_radiance(0)
                             : nacre_relief_lookup(nacre_relief_passed_on, nacre_relief_seen(texel, towards, along, size));
    }
    if (nacre_relief_last == 1) {
        color = vec4(texelFetch(nacre_relief_before, at, 0).rgb + light, 1.0);
    } else {
        vec3 direct = reflected(n, albedo, nacre_relief_light, nacre_relief_to) * nacre_relief_irradiance;
        color = vec4(light + lit_at_centre(texel) * direct, 1.0);
    }

#elif NACRE_RELIEF_STEP == NACRE_RELIEF_TOTAL
    vec3 direct = reflected(n, albedo, nacre_relief_light, nacre_relief_to) * nacre_relief_irradiance;
    color = vec4(lit_at_centre(texel) * direct + texelFetch(nacre_relief_passed_on, texel, 0).rgb, 1.0);
#endif
}
