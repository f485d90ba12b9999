// How much of each light doesn't reach the pixels of the picture: with #define NACRE_LIGHT_LEVELS. C++: SampledShadows
// (shading/hybrid/sampled_shadows.hpp).
#ifndef NACRE_BIND_LIGHT_LEVELS_GLSL
#define NACRE_BIND_LIGHT_LEVELS_GLSL

#ifdef NACRE_LIGHT_LEVELS
uniform sampler2DArray nacre_light_levels;  // a layer a light
#endif

#endif
