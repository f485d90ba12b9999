// Radiance by direction: where a direction lies in each layout, lookups in chains of prefiltered maps, and what a
// surface makes of them (HSE sections 1.4 to 1.6). C++ twins: envPosition, envDirection and sampleEnv of
// core/environment.hpp, lookups to 2e-3 relative with half floats (tests/shading/environment_glsl_test.cpp).
#ifndef NACRE_ENVIRONMENT_GLSL
#define NACRE_ENVIRONMENT_GLSL

#include "nacre/mappings.glsl"

// core/environment.hpp's EnvLayout, same order. `size` N: the map is 2N x N, N x 6N, N x 2N, N x N texels.
#define NACRE_ENV_LATLONG 0
#define NACRE_ENV_CUBE 1
#define NACRE_ENV_DUAL_PARABOLOID 2
#define NACRE_ENV_OCTAHEDRAL 3

// Seam-centred: the outermost texel centres lie at c = -1 and 1, so that clamped bilinear lookups meet across the seam.
vec2 nacre_env_seam_position(vec2 c, float size) { return 0.5 * (c + 1.0) * (size - 1.0) + 0.5; }
vec2 nacre_env_seam_coordinate(vec2 position, float size) {
    return size == 1.0 ? vec2(0.0) : 2.0 * (position - 0.5) / (size - 1.0) - 1.0;
}

// Folds the octahedron's lower half outwards, and back.
vec2 nacre_env_fold(vec2 c) { return (1.0 - abs(c.yx)) * vec2(c.x < 0.0 ? -1.0 : 1.0, c.y < 0.0 ? -1.0 : 1.0); }

// Texel coordinates of a direction (any length > 0), row 0 on top; not for a cube, which the sampler addresses. The
// latitude-longitude map's pole has longitude 0, as in C++ (GLSL's atan(0, 0) is undefined).
vec2 nacre_env_position(int kind, vec3 d, float size) {
    if (kind == NACRE_ENV_LATLONG) {
        float longitude = d.x == 0.0 && d.z == 0.0 ? 0.0 : atan(d.x, d.z);
        float latitude = atan(d.y, length(d.xz));
        return vec2(1.0, 0.5) * size - vec2(longitude, latitude) * (size / 3.14159265358979);
    }
    if (kind == NACRE_ENV_DUAL_PARABOLOID) {
        vec2 c = vec2(d.x, -d.y) / (length(d) + abs(d.z));
        return nacre_env_seam_position(c, size) + vec2(0.0, d.z < 0.0 ? size : 0.0);
    }
    vec2 c = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
    if (d.z < 0.0) c = nacre_env_fold(c);
    return nacre_env_seam_position(vec2(c.x, -c.y), size);
}

// Inverse of nacre_env_position, and of the cube's image as core/environment.hpp has it (faces +X -X +Y -Y +Z -Z from
// top to bottom, each as OpenEXR's: mirrored against OpenGL's faces).
vec3 nacre_env_direction(int kind, vec2 position, float size) {
    if (kind == NACRE_ENV_LATLONG) {
        float latitude = 3.14159265358979 * (0.5 - position.y / size);
        float longitude = 3.14159265358979 * (1.0 - position.x / size);
        return vec3(sin(longitude) * cos(latitude), sin(latitude), cos(longitude) * cos(latitude));
    }
    if (kind == NACRE_ENV_CUBE) {
        float face = clamp(floor(position.y / size), 0.0, 5.0);
        vec2 c = 2.0 * (position - vec2(0.0, face * size)) / size - 1.0;
        float s = mod(face, 2.0) < 0.5 ? 1.0 : -1.0;
        vec3 d = vec3(-s * c.x, -c.y, s);
        if (face < 1.5) d = vec3(s, -c.y, s * c.x);
        else if (face < 3.5) d = vec3(c.x, s, -s * c.y);
        return normalize(d);
    }
    if (kind == NACRE_ENV_DUAL_PARABOLOID) {
        bool back = position.y >= size;
        vec2 c = nacre_env_seam_coordinate(position - vec2(0.0, back ? size : 0.0), size) * vec2(1.0, -1.0);
        float r2 = dot(c, c);
        return vec3(2.0 * c, back ? r2 - 1.0 : 1.0 - r2) / (1.0 + r2);
    }
    vec2 c = nacre_env_seam_coordinate(position, size) * vec2(1.0, -1.0);
    vec3 d = vec3(c, 1.0 - abs(c.x) - abs(c.y));
    if (d.z < 0.0) d.xy = nacre_env_fold(c);
    return normalize(d);
}

// One level of a chain that is no cube. C++: sampleEnv.
vec3 nacre_env_level(sampler2D chain, int kind, vec3 d, int level) {
    vec2 extent = vec2(textureSize(chain, level));
    float size = kind == NACRE_ENV_LATLONG ? extent.y : extent.x;
    return textureLod(chain, nacre_env_position(kind, d, size) / extent, float(level)).rgb;
}

// Two neighbouring levels, blended: each has its own N, which the hardware's blend between mip levels doesn't know.
// lod within the levels.
vec3 nacre_env_chain(sampler2D chain, int kind, vec3 d, float lod) {
    float low = floor(lod);
    vec3 fine = nacre_env_level(chain, kind, d, int(low));
    if (lod == low) return fine;
    return mix(fine, nacre_env_level(chain, kind, d, int(low) + 1), lod - low);
}

// The same of a cube: its own mip levels and seamless filter. d in world directions, no flips: GpuEnvironment turned
// the faces.
vec3 nacre_env_cube_chain(samplerCube chain, vec3 d, float lod) { return textureLod(chain, d, lod).rgb; }

// The viewing direction mirrored about n, pointing away from the surface. `to_eye` and n unit.
vec3 nacre_env_reflect(vec3 to_eye, vec3 n) { return 2.0 * dot(n, to_eye) * n - to_eye; }

// The viewing direction refracted into a medium of relative index `ior` beyond n, pointing away from the eye; (0, 0, 0)
// where all is reflected (ior < 1).
vec3 nacre_env_refract(vec3 to_eye, vec3 n, float ior) { return refract(-to_eye, n, 1.0 / ior); }

// Fresnel table, mapping sqrt_cos: N x 1 texels of F over sqrt(cos theta).
vec3 nacre_env_fresnel(sampler2D table, vec4 scale, vec4 bias, float cos_theta) {
    return nacre_lookup(table, vec2(sqrt(clamp(cos_theta, 0.0, 1.0)), 0.0), scale, bias).rgb;
}

// Scale and bias of f0, mapping cos_perceptual: sqrt(n.v) across, perceptual roughness down.
vec2 nacre_env_scale_bias(sampler2D table, vec4 scale, vec4 bias, float cos_v, float perceptual_roughness) {
    return nacre_lookup(table, vec2(sqrt(clamp(cos_v, 0.0, 1.0)), perceptual_roughness), scale, bias).xy;
}

// f0 * scale + bias (Karis 2013).
vec3 nacre_env_reflectance(vec3 f0, vec2 scale_bias) { return f0 * scale_bias.x + scale_bias.y; }

// The same with what the facets reflect among themselves beyond the first time (Fdez-Aguera 2019); 1 where f0 = 1.
vec3 nacre_env_multiple_scattering(vec3 f0, vec2 scale_bias) {
    vec3 single = nacre_env_reflectance(f0, scale_bias);
    float missing = 1.0 - scale_bias.x - scale_bias.y;
    vec3 average = f0 + (1.0 - f0) / 21.0;
    return single + single * average * missing / (1.0 - average * missing);
}

// F Lm + Ld and F Lm + (1 - F) Ld (HSE section 1.5).
vec3 nacre_env_add(vec3 f, vec3 mirror, vec3 diffuse) { return f * mirror + diffuse; }
vec3 nacre_env_blend(vec3 f, vec3 mirror, vec3 diffuse) { return f * mirror + (1.0 - f) * diffuse; }

#endif
