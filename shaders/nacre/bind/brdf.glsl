// The surface's BRDF, factored or evaluated directly: the program's #defines choose.
#ifndef NACRE_BIND_BRDF_GLSL
#define NACRE_BIND_BRDF_GLSL

// Alpha of the slopes that a relief's level leaves out (nacre/bind/lamps.glsl sets it). Tables keep their own width.
#ifdef NACRE_BUMP_ROUGHNESS
float nacre_brdf_added_alpha = 0.0;
#endif

#ifdef NACRE_DIRECT
#include "nacre/bind/direct_brdf.glsl"
#else
#include "nacre/bind/factored_brdf.glsl"
#endif

// f(wi, wo) [1/sr] in the local frame.
vec3 nacre_brdf(vec3 wi, vec3 wo) {
#ifdef NACRE_DIRECT
    return nacre_direct_brdf(wi, wo);
#else
    return nacre_factored_brdf(wi, wo);
#endif
}

#endif
