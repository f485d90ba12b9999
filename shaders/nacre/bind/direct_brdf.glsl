// A BRDF evaluated from its formula, the baseline of run-time cost. The program chooses with #define NACRE_DIRECT
// NACRE_DIRECT_WARD and so on. C++: GpuDirectBrdf (shading/gpu_direct_brdf.hpp) sets defines and uniforms; the twins are
// factorize/models (tests/shading/direct_brdf_test.cpp).
#ifndef NACRE_BIND_DIRECT_BRDF_GLSL
#define NACRE_BIND_DIRECT_BRDF_GLSL

#define NACRE_DIRECT_LAMBERT 0
#define NACRE_DIRECT_COSINE_LOBE 1  // Phong too
#define NACRE_DIRECT_BLINN_PHONG 2
#define NACRE_DIRECT_MICROFACET 3  // torrance-sparrow, cook-torrance, ggx
#define NACRE_DIRECT_WARD 4
#define NACRE_DIRECT_ASHIKHMIN_SHIRLEY 5
#define NACRE_DIRECT_SCHLICK 6
#define NACRE_DIRECT_BANKS 7
#define NACRE_DIRECT_SGD 8

#define NACRE_D_BECKMANN 0
#define NACRE_D_GGX 1
#define NACRE_D_GAUSSIAN 2
#define NACRE_G_SMITH 0
#define NACRE_G_SMITH_CORRELATED 1
#define NACRE_G_V_CAVITY 2
#define NACRE_F_NONE 0
#define NACRE_F_SCHLICK 1
#define NACRE_F_DIELECTRIC 2
#define NACRE_F_CONDUCTOR 3
#define NACRE_WARD_1992 0
#define NACRE_WARD_DUER 1
#define NACRE_WARD_GMD 2

// 0: widths or exponents x, y; scale of the distribution; factor of the visibility. 1: kd/pi. 2: ks, with any
// normalisation. 3: eta, f0, rs or the lobe's axis. 4: k. SGD: nacre/direct_sgd.glsl.
uniform vec4 nacre_direct_params[16];

// The microfacets' widths, with those of slopes that a relief's levels leave out.
#ifdef NACRE_BUMP_ROUGHNESS
#include "nacre/bump.glsl"
vec2 nacre_direct_widths() {
    return vec2(nacre_bump_alpha(nacre_direct_params[0].x, nacre_brdf_added_alpha),
                nacre_bump_alpha(nacre_direct_params[0].y, nacre_brdf_added_alpha));
}
#else
vec2 nacre_direct_widths() { return nacre_direct_params[0].xy; }
#endif

#if NACRE_DIRECT == NACRE_DIRECT_MICROFACET
#include "nacre/direct_distribution.glsl"
#include "nacre/direct_fresnel.glsl"
#include "nacre/direct_visibility.glsl"

float nacre_direct_distribution(vec3 h) {
#if NACRE_D == NACRE_D_BECKMANN
    return nacre_distribution_beckmann(h, nacre_direct_widths().x);
#elif NACRE_D == NACRE_D_GGX
    return nacre_distribution_ggx(h, nacre_direct_widths());
#else
    return nacre_distribution_gaussian(h, nacre_direct_params[0].x, nacre_direct_params[0].z);
#endif
}

float nacre_direct_visibility(vec3 wi, vec3 wo) {
#if NACRE_G == NACRE_G_V_CAVITY
    return nacre_visibility_v_cavity(wi, wo);
#elif NACRE_G == NACRE_G_SMITH_CORRELATED
    return nacre_visibility_ggx_correlated(wi, wo, nacre_direct_widths());
#elif NACRE_D == NACRE_D_GGX
    return nacre_visibility_ggx_smith(wi, wo, nacre_direct_widths());
#else
    return nacre_visibility_beckmann_smith(wi, wo, nacre_direct_widths().x);
#endif
}

vec3 nacre_direct_fresnel(float c) {
#if NACRE_F == NACRE_F_NONE
    return vec3(1.0);
#elif NACRE_F == NACRE_F_SCHLICK
    return nacre_fresnel_schlick(c, nacre_direct_params[3].rgb);
#elif NACRE_F == NACRE_F_DIELECTRIC
#ifdef NACRE_F_GRAY
    return vec3(nacre_fresnel_dielectric(c, nacre_direct_params[3].r));
#else
    return nacre_fresnel_dielectric3(c, nacre_direct_params[3].rgb);
#endif
#else
#ifdef NACRE_F_GRAY
    return vec3(nacre_fresnel_conductor(c, nacre_direct_params[3].r, nacre_direct_params[4].r));
#else
    return nacre_fresnel_conductor3(c, nacre_direct_params[3].rgb, nacre_direct_params[4].rgb);
#endif
#endif
}
#elif NACRE_DIRECT == NACRE_DIRECT_WARD
#include "nacre/direct_ward.glsl"
#elif NACRE_DIRECT == NACRE_DIRECT_ASHIKHMIN_SHIRLEY
#include "nacre/direct_ashikhmin_shirley.glsl"
#elif NACRE_DIRECT == NACRE_DIRECT_SCHLICK
#include "nacre/direct_schlick.glsl"
#elif NACRE_DIRECT == NACRE_DIRECT_BANKS
#include "nacre/direct_banks.glsl"
#elif NACRE_DIRECT == NACRE_DIRECT_SGD
#include "nacre/direct_sgd.glsl"
#elif NACRE_DIRECT != NACRE_DIRECT_LAMBERT
#include "nacre/direct_phong.glsl"
#endif

// f(wi, wo) [1/sr] in the local frame; 0 when either direction is at or below the horizon.
vec3 nacre_direct_brdf(vec3 wi, vec3 wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
    vec4 first = nacre_direct_params[0];
    vec3 diffuse = nacre_direct_params[1].rgb;
    vec3 ks = nacre_direct_params[2].rgb;
#if NACRE_DIRECT == NACRE_DIRECT_LAMBERT
    return diffuse;
#elif NACRE_DIRECT == NACRE_DIRECT_COSINE_LOBE
    return diffuse + nacre_cosine_lobe(wi, wo, nacre_direct_params[3].xyz, first.x, ks);
#elif NACRE_DIRECT == NACRE_DIRECT_BLINN_PHONG
    return diffuse + nacre_blinn_phong(wi, wo, first.x, ks);
#elif NACRE_DIRECT == NACRE_DIRECT_MICROFACET
    vec3 sum = wi + wo;
    float size = length(sum);
    float facets = nacre_direct_distribution(sum / size) * nacre_direct_visibility(wi, wo) * first.w;
    return diffuse + ks * nacre_direct_fresnel(min(1.0, 0.5 * size)) * facets;
#elif NACRE_DIRECT == NACRE_DIRECT_WARD
#if NACRE_WARD == NACRE_WARD_1992
    return diffuse + ks * nacre_ward_1992(wi, wo, first.xy);
#elif NACRE_WARD == NACRE_WARD_DUER
    return diffuse + ks * nacre_ward_duer(wi, wo, first.xy);
#else
    return diffuse + ks * nacre_ward_gmd(wi, wo, first.xy);
#endif
#elif NACRE_DIRECT == NACRE_DIRECT_ASHIKHMIN_SHIRLEY
    return nacre_ashikhmin_shirley(wi, wo, first.xy, first.z, nacre_direct_params[3].rgb, diffuse);
#elif NACRE_DIRECT == NACRE_DIRECT_SCHLICK
    return diffuse + nacre_schlick(wi, wo, first.x, first.y, nacre_direct_params[3].rgb);
#elif NACRE_DIRECT == NACRE_DIRECT_BANKS
    return nacre_banks(wi.x, wo.x, first.x, diffuse, ks);
#elif NACRE_DIRECT == NACRE_DIRECT_SGD
    return diffuse + nacre_sgd(wi, wo, nacre_direct_params);
#endif
}

#endif
