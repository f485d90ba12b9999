// Where a mesh stands in the world. C++: setModel (shading/pass_state.hpp); nacre::transformed (core/scene_description.hpp)
// is the twin, to 1e-5 (tests/shading/model_matrix_test.cpp).
#ifndef NACRE_BIND_MODEL_GLSL
#define NACRE_BIND_MODEL_GLSL

uniform mat4 nacre_mesh_to_world;
uniform mat3 nacre_mesh_normal_to_world;  // its inverse transpose, times anything > 0
uniform float nacre_mesh_handedness;      // -1: the matrix mirrors

vec3 nacre_mesh_position(vec3 position) { return (nacre_mesh_to_world * vec4(position, 1.0)).xyz; }

// Unit, as vertices of a moved mesh have them: what interpolates between is then the same.
vec3 nacre_mesh_normal(vec3 normal) { return normalize(nacre_mesh_normal_to_world * normal); }

// xyz orthogonal to world_normal and unit, 0 where nothing of it is left (nacre_frame then takes any perpendicular).
vec4 nacre_mesh_tangent(vec4 tangent, vec3 world_normal) {
    vec3 t = mat3(nacre_mesh_to_world) * tangent.xyz;
    t -= dot(t, world_normal) * world_normal;
    float size = length(t);
    return vec4(size > 0.0 ? t / size : vec3(0.0), nacre_mesh_handedness * tangent.w);
}

#endif
