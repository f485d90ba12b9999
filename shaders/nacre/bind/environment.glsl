// The surrounding as a light: prefiltered maps, and how a surface reflects and transmits them. Only what the program's
// #defines ask for is compiled in:
//   NACRE_ENV_LAYOUT        NACRE_ENV_CUBE, ... of all maps alike
//   NACRE_ENV_REFLECTION    a chain looked up with the mirrored viewing direction
//   NACRE_ENV_TRANSMISSION  a chain looked up with the refracted viewing direction
//   NACRE_ENV_DIFFUSE       irradiance/pi, looked up with the normal
//   NACRE_ENV_WEIGHT        what weighs the reflection: NACRE_ENV_ONE, _FRESNEL (table), _SCALE_BIAS (table and f0)
//   NACRE_ENV_COMBINE       NACRE_ENV_ADD: W Lm + D; NACRE_ENV_BLEND: W Lm + (1 - W) D; D = transmitted + diffuse
// C++: shading/environment_pass.hpp sets defines and uniforms; surroundedRadiance (reference/environment_shading.hpp) is
// the twin, to 1e-3 (tests/shading/environment_pass_test.cpp).
#ifndef NACRE_BIND_ENVIRONMENT_GLSL
#define NACRE_BIND_ENVIRONMENT_GLSL

#include "nacre/environment.glsl"

#define NACRE_ENV_ONE 0
#define NACRE_ENV_FRESNEL 1
#define NACRE_ENV_SCALE_BIAS 2
#define NACRE_ENV_SCALE_BIAS_MULTIPLE 3
#define NACRE_ENV_ADD 0
#define NACRE_ENV_BLEND 1

#ifndef NACRE_ENV_LAYOUT
#define NACRE_ENV_LAYOUT NACRE_ENV_CUBE
#endif
#ifndef NACRE_ENV_WEIGHT
#define NACRE_ENV_WEIGHT NACRE_ENV_ONE
#endif
#ifndef NACRE_ENV_COMBINE
#define NACRE_ENV_COMBINE NACRE_ENV_ADD
#endif

#if NACRE_ENV_LAYOUT == NACRE_ENV_CUBE
uniform samplerCube nacre_env_reflection_cube;
uniform samplerCube nacre_env_transmission_cube;
uniform samplerCube nacre_env_diffuse_cube;
#define NACRE_ENV_REFLECTED(d) nacre_env_cube_chain(nacre_env_reflection_cube, d, nacre_env_lod.x)
#define NACRE_ENV_TRANSMITTED(d) nacre_env_cube_chain(nacre_env_transmission_cube, d, nacre_env_lod.y)
#define NACRE_ENV_DIFFUSED(d) nacre_env_cube_chain(nacre_env_diffuse_cube, d, nacre_env_lod.z)
#else
uniform sampler2D nacre_env_reflection_map;
uniform sampler2D nacre_env_transmission_map;
uniform sampler2D nacre_env_diffuse_map;
#define NACRE_ENV_REFLECTED(d) nacre_env_chain(nacre_env_reflection_map, NACRE_ENV_LAYOUT, d, nacre_env_lod.x)
#define NACRE_ENV_TRANSMITTED(d) nacre_env_chain(nacre_env_transmission_map, NACRE_ENV_LAYOUT, d, nacre_env_lod.y)
#define NACRE_ENV_DIFFUSED(d) nacre_env_chain(nacre_env_diffuse_map, NACRE_ENV_LAYOUT, d, nacre_env_lod.z)
#endif
uniform vec3 nacre_env_lod;                 // of reflection, transmission and diffuse map, within their levels
uniform vec3 nacre_env_reflection_color;    // factors of the maps, their storage's scale included
uniform vec3 nacre_env_transmission_color;
uniform vec3 nacre_env_diffuse_color;
uniform float nacre_env_ior;                // beyond the surface, relative to the viewer's side
uniform mat3 nacre_env_from_world;          // turns the surrounding
uniform sampler2D nacre_env_table;          // Fresnel, or scale and bias
uniform vec4 nacre_env_table_scale;
uniform vec4 nacre_env_table_bias;
uniform vec3 nacre_env_f0;                  // scale and bias
uniform float nacre_env_perceptual_roughness;

vec3 nacre_env_weight(float cos_v) {
#if NACRE_ENV_WEIGHT == NACRE_ENV_FRESNEL
    return nacre_env_fresnel(nacre_env_table, nacre_env_table_scale, nacre_env_table_bias, cos_v);
#elif NACRE_ENV_WEIGHT == NACRE_ENV_ONE
    return vec3(1.0);
#else
    vec2 pair = nacre_env_scale_bias(nacre_env_table, nacre_env_table_scale, nacre_env_table_bias, cos_v,
                                     nacre_env_perceptual_roughness);
#if NACRE_ENV_WEIGHT == NACRE_ENV_SCALE_BIAS
    return nacre_env_reflectance(nacre_env_f0, pair);
#else
    return nacre_env_multiple_scattering(nacre_env_f0, pair);
#endif
#endif
}

// Radiance towards the eye; both unit, world directions. 0 where the surface is seen from behind. sky: share of the
// diffuse light that reaches the point.
vec3 nacre_env_radiance(vec3 to_eye, vec3 n, float sky) {
    float cos_v = dot(n, to_eye);
    if (cos_v <= 0.0) return vec3(0.0);
    vec3 weight = nacre_env_weight(cos_v);
    vec3 mirror = vec3(0.0);
    vec3 rest = vec3(0.0);
#ifdef NACRE_ENV_REFLECTION
    vec3 r = nacre_env_from_world * nacre_env_reflect(to_eye, n);
    mirror = nacre_env_reflection_color * NACRE_ENV_REFLECTED(r);
#endif
#ifdef NACRE_ENV_TRANSMISSION
    vec3 t = nacre_env_from_world * nacre_env_refract(to_eye, n, nacre_env_ior);
    if (t != vec3(0.0)) rest += nacre_env_transmission_color * NACRE_ENV_TRANSMITTED(t);
#endif
#ifdef NACRE_ENV_DIFFUSE
    rest += sky * nacre_env_diffuse_color * NACRE_ENV_DIFFUSED(nacre_env_from_world * n);
#endif
#if NACRE_ENV_COMBINE == NACRE_ENV_BLEND
    return nacre_env_blend(weight, mirror, rest);
#else
    return nacre_env_add(weight, mirror, rest);
#endif
}

#endif
