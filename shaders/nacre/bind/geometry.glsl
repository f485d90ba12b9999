// What each pixel of a view shows. C++: GeometryBuffer (shading/hybrid/geometry_buffer.hpp).
#ifndef NACRE_BIND_GEOMETRY_GLSL
#define NACRE_BIND_GEOMETRY_GLSL

// Written:
uniform vec4 nacre_geometry_surface;    // albedo, and the node's index + 1
uniform float nacre_geometry_specular;  // 1 on specular surfaces

// Read, a texel a pixel:
uniform sampler2D nacre_geometry_place;   // in the world; w: the node's index + 1, 0 where nothing is
uniform sampler2D nacre_geometry_normal;  // unit; w: 1 on specular surfaces
uniform sampler2D nacre_geometry_albedo;  // 0 on back faces and specular surfaces; w: nacre_geometry_packed of the
                                          // triangle's normal, on the side that is seen

// A unit vector as an integer below 2^24, which a float holds: its octahedron's square in steps of 1 / 4095.
float nacre_geometry_packed(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    vec2 steps = floor(4095.0 * (0.5 * p + 0.5) + 0.5);
    return 4096.0 * steps.x + steps.y;
}

vec3 nacre_geometry_unpacked(float packed_normal) {
    float x = floor(packed_normal / 4096.0);
    vec2 p = vec2(x, packed_normal - 4096.0 * x) * (2.0 / 4095.0) - 1.0;
    float z = 1.0 - abs(p.x) - abs(p.y);
    if (z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return normalize(vec3(p, z));
}

#endif
