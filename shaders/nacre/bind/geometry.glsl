// What each pixel of a view shows. C++: GeometryBuffer (shading/hybrid/geometry_buffer.hpp).
#ifndef NACRE_BIND_GEOMETRY_GLSL
#define NACRE_BIND_GEOMETRY_GLSL

// Written:
uniform vec4 nacre_geometry_surface;    // albedo, and the node's index + 1
uniform float nacre_geometry_specular;  // 1 on specular surfaces

// Read, a texel a pixel:
uniform sampler2D nacre_geometry_place;   // in the world; w: the node's index + 1, 0 where nothing is
uniform sampler2D nacre_geometry_normal;  // unit; w: 1 on specular surfaces
uniform sampler2D nacre_geometry_albedo;  // 0 on back faces and specular surfaces

#endif
