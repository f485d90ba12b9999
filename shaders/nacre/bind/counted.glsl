// Counts of shadow volumes as images. C++: CountedShadows (shading/hybrid/counted_shadows.hpp).
#ifndef NACRE_BIND_COUNTED_GLSL
#define NACRE_BIND_COUNTED_GLSL

uniform float nacre_counted_value;      // what is added; of a filter the light of a point
uniform sampler2D nacre_counted_image;  // counts, or the shadow's levels

#endif
