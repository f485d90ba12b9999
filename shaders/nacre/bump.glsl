// Bump mapping with shadows (HSE section 3.1): normals, and whether a light is above the horizon of the relief, by
// ellipses (equations 7 to 9) or by horizon maps (Max 1988). Directions are in the surface's own frame: x along u, y along
// v, z out. C++ twins: bump/ and shading/shading_frame.hpp, to 2e-3 with half floats (tests/shading/bump_test.cpp).
#ifndef NACRE_BUMP_GLSL
#define NACRE_BUMP_GLSL

#include "nacre/frame.glsl"

// The side of mirrored tiles: relief directions x and y turn over in every second one (GL_MIRRORED_REPEAT). 1 or -1 each.
vec2 nacre_bump_mirror(vec2 uv) { return 1.0 - 2.0 * mod(floor(uv), 2.0); }

// xyz: unit normal of the relief; w: alpha of the slopes that the level leaves out, 0 where the texture has none (its
// fourth channel then reads 1, and the program doesn't ask). C++: normalAt (bump/bump_lookup.hpp), at the finest level.
vec4 nacre_bump_normal(sampler2D normals, vec2 uv) {
    vec4 texel = texture(normals, uv);
    float size = length(texel.xyz);
    return vec4(size > 0.0 ? texel.xyz / size : vec3(0.0, 0.0, 1.0), texel.w);
}

// The frame of the BRDF: bumped normal, the tangent made orthogonal to it. A normal that faces away from a viewer who
// sees the surface (which no relief shows) is tilted until n.v is about 0.05, or that of the surface if it is less. Surfaces
// seen from behind keep their own frame. C++: bumpedFrame (shading/shading_frame.hpp).
mat3 nacre_bump_frame(mat3 mesh, float handedness, vec3 normal, vec3 to_eye) {
    float facing = dot(mesh[2], to_eye);
    if (facing <= 0.0) return mesh;
    vec3 n = mesh * normal;
    float missing = min(facing, 0.05) - dot(n, to_eye);
    if (missing > 0.0) n += missing * to_eye;
    return nacre_frame(n, vec4(mesh[0], handedness));
}

// A material's alpha with that of the slopes a level leaves out: variances add. C++: bumpedAlpha (bump/bump_levels.hpp).
float nacre_bump_alpha(float material, float relief) { return sqrt(material * material + relief * relief); }

// 1 - |M l + o|^2, lit when >= 0; shape = (m11, m12, m22). C++: ellipseValue (bump/horizon_ellipses.hpp).
float nacre_ellipse_value(vec3 shape, vec2 offset, vec3 light) {
    vec2 p = vec2(dot(shape.xy, light.xy), dot(shape.yz, light.xy)) + offset;
    return 1.0 - dot(p, p);
}

// Elevation [rad] of the horizon towards light.xy, linear between azimuths. horizons: azimuth 2 pi k / count in channel
// k mod 4 of layer k / 4. Two lookups always: neither depends on a branch, so that levels may be chosen by derivatives.
// C++: horizonElevation (bump/horizon_map.hpp) at a texel.
float nacre_horizon_elevation(sampler2DArray horizons, int count, vec2 uv, vec3 light) {
    float turns = light.x == 0.0 && light.y == 0.0 ? 0.0 : atan(light.y, light.x) / 6.28318530717959;
    float place = fract(turns) * float(count);
    int low = min(int(place), count - 1);
    int high = low + 1 < count ? low + 1 : 0;
    vec4 first = texture(horizons, vec3(uv, float(low / 4)));
    vec4 second = texture(horizons, vec3(uv, float(high / 4)));
    return mix(first[low % 4], second[high % 4], place - float(low));
}

// The light's elevation over the horizon's [rad]: lit when >= 0. C++: litMargin (bump/bump_lookup.hpp).
float nacre_horizon_margin(float elevation, vec3 light) { return atan(light.z, length(light.xy)) - elevation; }

// Share of a pixel that is lit. value: of the ellipse or the horizon; spread: half width of the values that a coarse
// level blended, 0 at the finest, where the edge is hard. C++: litShare (bump/bump_levels.hpp).
float nacre_lit_share(float value, float spread) {
    float hard = value >= 0.0 ? 1.0 : 0.0;
    return spread > 0.0 ? clamp(0.5 + 0.5 * value / spread, 0.0, 1.0) : hard;
}

// The same with an edge at least one pixel wide. Fragment shaders only, outside of branches: takes derivatives.
float nacre_lit_share_soft(float value, float spread) {
    return nacre_lit_share(value, max(spread, 0.5 * fwidth(value)));
}

#endif
