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
    vec3 d = nacre_relief_to_sky * nacre_relief_directions[i].xyz;
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

float lit_at_centre(ivec2 texel) {
    return texelFetch(nacre_relief_lit, texel * nacre_relief_detail + nacre_relief_detail / 2, 0).r;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#if NACRE_RELIEF_STEP == NACRE_RELIEF_LEAVES
    vec3 fine = texelFetch(nacre_relief_fine, texel, 0).xyz;
    float cosine = max(0.0, dot(fine, nacre_relief_light)) * texelFetch(nacre_relief_lit, texel, 0).r;
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(nacre_relief_fine, 0));
    vec3 direct = nacre_relief_lookup(nacre_relief_albedo, uv) * nacre_relief_irradiance * (cosine / kNacreReliefPi);
    color = fine == vec3(0.0) ? vec4(0.0) : vec4(direct + nacre_relief_lookup(nacre_relief_passed_on, uv), 1.0);
#else
    vec4 normal = texelFetch(nacre_relief_normals, texel, 0);
    color = vec4(0.0);
    if (normal.xyz == vec3(0.0)) return;
    vec3 n = normal.xyz;
    vec3 albedo = texelFetch(nacre_relief_albedo, texel, 0).rgb;
    vec2 size = vec2(textureSize(nacre_relief_normals, 0));
#endif

#if NACRE_RELIEF_STEP == NACRE_RELIEF_SKY
    vec4 sum = texelFetch(nacre_relief_before, texel, 0);
    for (int i = 0; i < nacre_relief_count; ++i) {
        float w = nacre_relief_directions[i].w * max(0.0, dot(n, nacre_relief_directions[i].xyz));
        sum.a += w;
        if (nacre_relief_distance(nacre_relief_distances, texel, int(nacre_relief_towards[i].z)) < 0.0)
            sum.rgb += w * sky_radiance(i);
    }
    color = nacre_relief_last == 0 ? sum : vec4(sum.a > 0.0 ? albedo * sum.rgb / sum.a : vec3(0.0), 1.0);

#elif NACRE_RELIEF_STEP == NACRE_RELIEF_GATHER
    vec4 sum = texelFetch(nacre_relief_before, texel, 0);
    vec4 slopes = texelFetch(nacre_relief_slopes, texel, 0);
    vec3 own = albedo * nacre_relief_irradiance * (lit_at_centre(texel) / kNacreReliefPi);
    vec3 passed_on = texelFetch(nacre_relief_passed_on, texel, 0).rgb;
    for (int i = 0; i < nacre_relief_count; ++i) {
        float w = nacre_relief_directions[i].w * dot(n, nacre_relief_directions[i].xyz);
        if (w <= 0.0) continue;
        vec2 towards = nacre_relief_towards[i].xy;
        float along = nacre_relief_distance(nacre_relief_distances, texel, int(nacre_relief_towards[i].z));
        if (along < 0.0) continue;
        vec3 light = along > 0.0
                         ? nacre_relief_lookup(nacre_relief_leaves, nacre_relief_seen(texel, towards, along, size))
                         : own * nacre_relief_own(slopes, towards, nacre_relief_light) + passed_on;
        sum += w * vec4(light, 1.0);
    }
    color = sum;
    if (nacre_relief_last == 1) {
        vec3 mean = sum.a > 0.0 ? sum.rgb / sum.a
                                : nacre_relief_lookup(nacre_relief_leaves, nacre_relief_seen(texel, vec2(0.0), 0.0, size));
        color = vec4(albedo * mean * normal.w + texelFetch(nacre_relief_sky, texel, 0).rgb, 1.0);
    }

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
        color = vec4(texelFetch(nacre_relief_before, texel, 0).rgb + light, 1.0);
    } else {
        vec3 direct = reflected(n, albedo, nacre_relief_light, nacre_relief_to) * nacre_relief_irradiance;
        color = vec4(light + lit_at_centre(texel) * direct, 1.0);
    }

#elif NACRE_RELIEF_STEP == NACRE_RELIEF_TOTAL
    vec3 direct = reflected(n, albedo, nacre_relief_light, nacre_relief_to) * nacre_relief_irradiance;
    color = vec4(lit_at_centre(texel) * direct + texelFetch(nacre_relief_passed_on, texel, 0).rgb, 1.0);
#endif
}
