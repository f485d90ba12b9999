// Virtual lights of one pass, and their shadow maps. C++: addVirtualLights (shading/hybrid/indirect_pass.hpp).
#ifndef NACRE_BIND_VIRTUAL_LIGHTS_GLSL
#define NACRE_BIND_VIRTUAL_LIGHTS_GLSL

uniform int nacre_virtual_count;
uniform vec4 nacre_virtual_place[48];   // middle of the rectangle; area / pi
uniform vec4 nacre_virtual_normal[48];  // w: z of the shadow map's eye, whose x and y are those of the next two
uniform vec4 nacre_virtual_u[48];       // half edges of the rectangle
uniform vec4 nacre_virtual_v[48];
uniform vec4 nacre_virtual_power[48];   // over pi
uniform sampler2DArray nacre_virtual_maps;  // with NACRE_VIRTUAL_SHADOWS: a paraboloid of linear depth a light
uniform int nacre_virtual_layer;            // of the first light
uniform vec4 nacre_virtual_drawn;           // \see nacre_virtual_lit

#endif
