// Light arriving at a point.
#ifndef NACRE_LIGHT_GLSL
#define NACRE_LIGHT_GLSL

// xyz: vector towards the viewer (to_eye, w = 1: eye position; w = 0: direction of an orthographic view) or towards the
// light (same rule), as unit vector.
vec3 nacre_direction_to(vec4 target, vec3 point) { return normalize(target.xyz - target.w * point); }

// Share of a light's color that reaches a facing surface: 1 for a directional light (w = 0), 1/distance^2 for a point.
float nacre_light_falloff(vec4 light, vec3 point) {
    vec3 away = light.xyz - point;
    return light.w == 0.0 ? 1.0 : 1.0 / dot(away, away);
}

// Share of a spot's intensity that leaves into `to_light`'s opposite: saturate((cos - cos outer) / (cos inner -
// cos outer))^2, as in KHR_lights_punctual. cone: axis / (cos inner - cos outer), and -cos outer / (the same); (0, 0, 0,
// 1) without a cone. to_light: unit. C++: coneShare (core/scene.hpp), to 1e-4 for cones with edges of 0.01 in the
// cosine (tests/shading/light_test.cpp).
float nacre_cone_share(vec4 cone, vec3 to_light) {
    float share = clamp(cone.w - dot(cone.xyz, to_light), 0.0, 1.0);
    return share * share;
}

#endif
