// What the programs of light in reliefs are told. C++: GpuReliefLight (shading/gpu_relief_light.cpp).
#ifndef NACRE_BIND_RELIEF_LIGHT_GLSL
#define NACRE_BIND_RELIEF_LIGHT_GLSL

uniform sampler2DArray nacre_relief_distances;  // see nacre_relief_distance
uniform sampler2D nacre_relief_normals;         // xyz normal, 0 in holes; w SeenPoints::share
uniform sampler2D nacre_relief_albedo;          // rgb; a = 0 in holes
uniform sampler2D nacre_relief_slopes;          // of the patches at the centre: towards -x, +x, -y, +y
uniform sampler2D nacre_relief_own_shares;      // SeenPoints::own; of patches, the own one's has SeenPoints::share
uniform sampler2DArray nacre_relief_points;     // SeenPoints::offsets, two a layer
uniform sampler2D nacre_relief_fine;            // normals of the patches, laid out as PatchSamples of a period
uniform sampler2D nacre_relief_lit;             // where the light is seen, as fine
uniform sampler2D nacre_relief_leaves;          // radiance of all light, as fine
uniform sampler2D nacre_relief_passed_on;       // radiance without direct light, four patches a texel; or along a path
uniform sampler2D nacre_relief_sky;             // radiance straight from the sky
uniform sampler2D nacre_relief_before;          // sums of the draws before
uniform samplerCube nacre_relief_sky_cube;      // the surrounding
uniform mat3 nacre_relief_to_sky;               // turns directions of the relief to the surrounding's
uniform int nacre_relief_detail;                // PatchSamples::k
uniform int nacre_relief_patches;               // 1: results have four patches a texel, of a period
uniform vec2 nacre_relief_side;                 // of the tile drawn: -1 where the relief is turned over
uniform vec3 nacre_relief_light;                // unit, towards the light
uniform vec3 nacre_relief_irradiance;
uniform vec3 nacre_relief_to;                   // unit, towards the viewer, or the texel that sees this one
uniform int nacre_relief_count;                 // of directions in this draw, or of points
uniform int nacre_relief_last;                  // 1: the last draw of a sum; what it means depends on the step
uniform float nacre_relief_factor;              // of a path's segment: 1/density; at the viewer's end shared by the paths
uniform vec4 nacre_relief_directions[16];       // unit direction, weight [sr]
uniform vec4 nacre_relief_towards[16];          // its part along the plane, unit; number in the scatter map
uniform vec4 nacre_relief_sky_colors[16];       // radiance from there, or factor of the surrounding's

#endif
