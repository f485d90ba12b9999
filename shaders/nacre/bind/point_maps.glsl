// Shadow maps of a light's points, in one texture: a row a point, a column a face of the cube around it. C++:
// MappedShadows (shading/hybrid/mapped_shadows.hpp).
#ifndef NACRE_BIND_POINT_MAPS_GLSL
#define NACRE_BIND_POINT_MAPS_GLSL

uniform mat4 nacre_point_to_clip;  // drawing: from the world

uniform sampler2D nacre_point_maps;
uniform vec4 nacre_point_places[64];  // in the world
uniform vec4 nacre_point_depth;       // depth = x - y / distance along the axis; z: the least distance; w: offset a distance
uniform int nacre_point_size;         // texels along a face's edge

// The axis of the face that v lies in: 0, 1 or 2.
int nacre_point_axis(vec3 v) {
    vec3 a = abs(v);
    return a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
}

// Right, up and along the axis.
vec3 nacre_point_turned(vec3 v, int axis) { return axis == 0 ? v.yzx : (axis == 1 ? v.zxy : v); }

#endif
