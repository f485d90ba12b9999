// The factored BRDF of a surface: uniforms and dispatch. The program chooses the form with
// #define NACRE_FORM NACRE_FORM_COSINE and so on; only that form's file is compiled in.
// C++: GpuFactoredBrdf (shading/gpu_factored_brdf.hpp) sets the uniforms; evaluate (factorize/factored_brdf.hpp) is the
// twin, to 2e-3 relative for half textures (tests/shading/gpu_factored_test.cpp).
#ifndef NACRE_BIND_FACTORED_BRDF_GLSL
#define NACRE_BIND_FACTORED_BRDF_GLSL

#define NACRE_FORM_HALF_DIFF 0
#define NACRE_FORM_COSINE 1
#define NACRE_FORM_SINGLE_LOBE 2
#define NACRE_FORM_TANGENT 3
#define NACRE_FORM_HOMOMORPHIC 4
#define NACRE_FORM_SEPARABLE 5

#ifndef NACRE_FORM
#error "define NACRE_FORM, for instance as NACRE_FORM_HALF_DIFF"
#endif

uniform sampler2D nacre_brdf_tex0;
uniform sampler2D nacre_brdf_tex1;
uniform sampler2D nacre_brdf_tex2;
uniform sampler2D nacre_brdf_tex3;
uniform vec4 nacre_brdf_params[16];  // meaning per form: the form's own file
uniform vec4 nacre_brdf_scale[4];    // texture i means bias[i] + scale[i] * sample
uniform vec4 nacre_brdf_bias[4];

#if NACRE_FORM == NACRE_FORM_HALF_DIFF
#include "nacre/factored_half_diff.glsl"
#elif NACRE_FORM == NACRE_FORM_COSINE
#include "nacre/factored_cosine.glsl"
#elif NACRE_FORM == NACRE_FORM_SINGLE_LOBE
#include "nacre/factored_single_lobe.glsl"
#elif NACRE_FORM == NACRE_FORM_TANGENT
#include "nacre/factored_tangent.glsl"
#elif NACRE_FORM == NACRE_FORM_HOMOMORPHIC
#include "nacre/factored_homomorphic.glsl"
#elif NACRE_FORM == NACRE_FORM_SEPARABLE
#include "nacre/factored_separable.glsl"
#endif

// The constants, with those that choose a variant written as literals where the program gives them
// (#define NACRE_SPECIALIZE p[0].y = 3.0; ...): the compiler then drops the other variants, and their fetches.
void nacre_brdf_constants(out vec4 p[16]) {
    p = nacre_brdf_params;
#ifdef NACRE_SPECIALIZE
    NACRE_SPECIALIZE
#endif
}

// f(wi, wo) [1/sr] in the local frame; 0 when either direction is at or below the horizon.
vec3 nacre_factored_brdf(vec3 wi, vec3 wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
    vec4 p[16];
    nacre_brdf_constants(p);
#if NACRE_FORM == NACRE_FORM_HALF_DIFF
    return nacre_half_diff(nacre_brdf_tex0, nacre_brdf_tex1, p, nacre_brdf_scale, nacre_brdf_bias, wi, wo);
#elif NACRE_FORM == NACRE_FORM_COSINE
    return nacre_cosine(nacre_brdf_tex0, nacre_brdf_tex1, p, nacre_brdf_scale, nacre_brdf_bias, wi, wo);
#elif NACRE_FORM == NACRE_FORM_SINGLE_LOBE
    return nacre_single_lobe(nacre_brdf_tex0, p, nacre_brdf_scale, nacre_brdf_bias, wi, wo);
#elif NACRE_FORM == NACRE_FORM_TANGENT
    return nacre_tangent(nacre_brdf_tex0, p, nacre_brdf_scale, nacre_brdf_bias, wi, wo);
#elif NACRE_FORM == NACRE_FORM_HOMOMORPHIC
    return nacre_homomorphic(nacre_brdf_tex0, nacre_brdf_tex1, nacre_brdf_tex2, p, nacre_brdf_scale,
                             nacre_brdf_bias, wi, wo);
#elif NACRE_FORM == NACRE_FORM_SEPARABLE
    return nacre_separable(nacre_brdf_tex0, nacre_brdf_tex1, nacre_brdf_tex2, nacre_brdf_tex3, p,
                           nacre_brdf_scale, nacre_brdf_bias, wi, wo);
#endif
}

#ifdef NACRE_TEXTURE_MATRIX
// The same from the coordinates that texture matrices give (forms cosine and tangent). cosines: cos theta_d, cos delta,
// cos alpha, cos beta; along: t.wi, t.wo. Both may be interpolated; cos alpha, cos beta > 0.
vec3 nacre_factored_brdf_at(vec4 cosines, vec2 along) {
    vec4 p[16];
    nacre_brdf_constants(p);
#if NACRE_FORM == NACRE_FORM_COSINE
    return nacre_cosine_at(nacre_brdf_tex0, nacre_brdf_tex1, p, nacre_brdf_scale, nacre_brdf_bias,
                           cosines.xy, cosines.zw);
#elif NACRE_FORM == NACRE_FORM_TANGENT
    return nacre_tangent_at(nacre_brdf_tex0, p, nacre_brdf_scale, nacre_brdf_bias, along);
#endif
}
#endif

#endif
