// The relief of a surface. Only what the program's #defines ask for is compiled in; without NACRE_BUMP the surface is
// smooth and always lit.
//   NACRE_BUMP            normals
//   NACRE_BUMP_SHADOW     NACRE_BUMP_NONE, _ELLIPSE, _HORIZON
//   NACRE_BUMP_SOFT       shadow edges one pixel wide
//   NACRE_BUMP_MIRROR     the tiles are mirrored
//   NACRE_BUMP_ROUGHNESS  the normals' fourth channel widens microfacet models
//   NACRE_BUMP_INDIRECT   index of the light whose indirect light nacre_bump_indirect holds
// C++: GpuBump (shading/gpu_bump.hpp) sets defines and uniforms.
#ifndef NACRE_BIND_BUMP_GLSL
#define NACRE_BIND_BUMP_GLSL

#include "nacre/bump.glsl"

#define NACRE_BUMP_NONE 0
#define NACRE_BUMP_ELLIPSE 1
#define NACRE_BUMP_HORIZON 2

#ifndef NACRE_BUMP_SHADOW
#define NACRE_BUMP_SHADOW NACRE_BUMP_NONE
#endif

#ifdef NACRE_BUMP
uniform vec2 nacre_bump_tiles;            // per unit of the mesh's uv
uniform sampler2D nacre_bump_normals;
uniform sampler2D nacre_bump_shape;       // m11, m12, m22, spread
uniform sampler2D nacre_bump_offset;      // o1, o2, share of the sky seen
uniform sampler2DArray nacre_bump_horizons;  // the layer after the last azimuth's: spread
uniform int nacre_bump_azimuths;
uniform sampler2D nacre_bump_indirect;    // radiance per unit of its light's colour
#endif

// What is the same for all lights of a point.
struct NacreBump {
    mat3 mesh;         // the surface's own frame: shadows
    mat3 frame;        // that of the bumped normal: reflectance
    float visibility;  // share of the sky seen
    float alpha;       // of slopes that the level leaves out
    vec3 indirect;
    vec4 shape;        // of the ellipse
    vec2 offset;
    vec2 uv;
};

// Takes derivatives: outside of branches. to_eye: unit, world.
NacreBump nacre_bump_point(mat3 mesh, float handedness, vec2 uv, vec3 to_eye) {
    NacreBump point = NacreBump(mesh, mesh, 1.0, 0.0, vec3(0.0), vec4(0.0), vec2(0.0), uv);
#ifdef NACRE_BUMP
    point.uv = uv * nacre_bump_tiles;
    vec4 normal = nacre_bump_normal(nacre_bump_normals, point.uv);
#ifdef NACRE_BUMP_MIRROR
    vec2 mirror = nacre_bump_mirror(point.uv);
    normal.xy *= mirror;
    // the shadow tests then are of the light as the tile's relief sees it
    point.mesh[0] *= mirror.x;
    point.mesh[1] *= mirror.y;
#endif
    point.frame = nacre_bump_frame(mesh, handedness, normal.xyz, to_eye);
#ifdef NACRE_BUMP_ROUGHNESS
    point.alpha = normal.w;
#endif
#if NACRE_BUMP_SHADOW == NACRE_BUMP_ELLIPSE
    point.shape = texture(nacre_bump_shape, point.uv);
    vec3 offset = texture(nacre_bump_offset, point.uv).xyz;
    point.offset = offset.xy;
    point.visibility = offset.z;
#endif
#ifdef NACRE_BUMP_INDIRECT
    point.indirect = texture(nacre_bump_indirect, point.uv).rgb;
#endif
#endif
    return point;
}

#if NACRE_BUMP_SHADOW != NACRE_BUMP_NONE
float nacre_bump_share(NacreBump point, vec3 light) {
#if NACRE_BUMP_SHADOW == NACRE_BUMP_ELLIPSE
    float value = nacre_ellipse_value(point.shape.xyz, point.offset, light);
    float spread = point.shape.w;
#else
    float elevation = nacre_horizon_elevation(nacre_bump_horizons, nacre_bump_azimuths, point.uv, light);
    float value = nacre_horizon_margin(elevation, light);
    float spread = texture(nacre_bump_horizons, vec3(point.uv, float((nacre_bump_azimuths + 3) / 4))).r;
#endif
#ifdef NACRE_BUMP_SOFT
    return nacre_lit_share_soft(value, spread);
#else
    return nacre_lit_share(value, spread);
#endif
}
#endif

// Share of a light that reaches the point; to_light: unit, world. 0 where the surface itself faces away from it. Takes
// derivatives: outside of branches.
float nacre_bump_lit(NacreBump point, vec3 to_light) {
#ifdef NACRE_BUMP
    vec3 light = nacre_to_local(point.mesh, to_light);
#if NACRE_BUMP_SHADOW == NACRE_BUMP_NONE
    return light.z > 0.0 ? 1.0 : 0.0;
#else
    float share = nacre_bump_share(point, light);
    return light.z > 0.0 ? share : 0.0;
#endif
#else
    return 1.0;
#endif
}

#endif
