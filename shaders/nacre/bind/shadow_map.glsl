// Drawing a light's depth map. C++: ShadowMap::update (shading/shadow_map.cpp).
#ifndef NACRE_BIND_SHADOW_MAP_GLSL
#define NACRE_BIND_SHADOW_MAP_GLSL

uniform mat4 nacre_shadow_from_mesh;  // into the layer's light space
uniform mat4 nacre_shadow_to_clip;    // of that; not for paraboloids
uniform vec4 nacre_shadow_drawn;      // depth of 0, 1 / (that of 1 less that), scale of a fan or paraboloid, edge [texels]
uniform vec3 nacre_shadow_square;     // of parallel rays: map coordinate = xy of light space * z + xy; for volumes alone
uniform sampler2D nacre_shadow_depth;  // one layer, to be stored in blocks
uniform vec2 nacre_shadow_stored;      // distance of depth 0, and of 1 less that
uniform int nacre_shadow_bits;         // 16 or 32

#endif
