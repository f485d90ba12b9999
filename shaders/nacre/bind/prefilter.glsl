// What the prefilter programs are told. C++: GpuPrefilter (shading/gpu_prefilter.cpp).
#ifndef NACRE_BIND_PREFILTER_GLSL
#define NACRE_BIND_PREFILTER_GLSL

uniform samplerCube nacre_prefilter_source;  // the surrounding, read at level 0
uniform sampler2D nacre_prefilter_strip;     // its copy as six faces below each other, with levels
uniform mat3 nacre_prefilter_destination;    // columns: s, t and middle of OpenGL's cube face that is drawn
uniform int nacre_prefilter_edge;            // of what is read or, in the copies, drawn [texels]
uniform float nacre_prefilter_size;          // edge of the face that is drawn [texels]
uniform int nacre_prefilter_first;           // levels of the strip that take part
uniform int nacre_prefilter_last;
uniform vec4 nacre_prefilter_lobe_values;    // parameter, width, support, detail: see NacrePrefilterPlan
uniform float nacre_prefilter_second;        // its second parameter, likewise
uniform vec3 nacre_prefilter_axis;           // of an anisotropic lobe, unit
uniform vec4 nacre_prefilter_part;           // levels and rows that this draw sums: see nacre_prefilter_sum
uniform int nacre_prefilter_goes_on;         // 1: the sum of the parts before is added
uniform int nacre_prefilter_ends;            // 1: the last part; divided, not left as a sum
uniform sampler2D nacre_prefilter_before;    // the sum of the parts before
uniform float nacre_prefilter_unseen;        // a sum of weights below this saw no texel's centre

#endif
