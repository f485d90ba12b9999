// The shading frame of a surface point.
#ifndef NACRE_FRAME_GLSL
#define NACRE_FRAME_GLSL

// Columns tangent, bitangent, normal; orthonormal. `normal`: interpolated, any length > 0. `tangent`: interpolated xyz,
// made orthogonal to the normal (Gram-Schmidt); w its handedness, bitangent = sign(w) * cross(normal, tangent). Where no
// tangent is left, any perpendicular serves: cross(n, x), or cross(n, y) when n leans towards x.
// C++: shadingFrame (shading/shading_frame.hpp), to 1e-6; reference/raytrace.cpp has its own (tests/shading/lit_test.cpp).
mat3 nacre_frame(vec3 normal, vec4 tangent) {
    vec3 n = normalize(normal);
    vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
    if (dot(t, t) < 1e-12) t = cross(n, abs(n.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0));
    t = normalize(t);
    return mat3(t, cross(n, t) * (tangent.w < 0.0 ? -1.0 : 1.0), n);
}

// A world direction in the frame's coordinates; no normalisation.
vec3 nacre_to_local(mat3 frame, vec3 world) { return vec3(dot(frame[0], world), dot(frame[1], world), dot(frame[2], world)); }

#endif
