// The surface value = iso of a volume, met along a ray. Texture coordinates throughout: the box is [0, 1]^3.
#ifndef NACRE_VOLUME_GLSL
#define NACRE_VOLUME_GLSL

// Where the ray from + t along, t in [0, 1], is within the box: x = first t, y = last; x > y: nowhere.
vec2 nacre_volume_span(vec3 from, vec3 along) {
    vec3 safe = mix(along, vec3(1e-20), lessThan(abs(along), vec3(1e-20)));
    vec3 a = -from / safe, b = (vec3(1.0) - from) / safe;
    vec3 low = min(a, b), high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, 0.0)), min(min(high.x, high.y), min(high.z, 1.0)));
}

// The value less iso, at `at`.
float nacre_volume_above(sampler3D volume, float iso, vec3 at) { return textureLod(volume, at, 0.0).a - iso; }

// Between t = below (outside the surface) and above (inside): four steps of the false position, the Illinois way, which
// halves the weight of an end that stays. Good to 1e-4 of a step on fields without kinks.
// C++: reference/volume_trace.hpp bisects.
float nacre_volume_crossing(sampler3D volume, float iso, vec3 from, vec3 along, float below, float above, float value_below, float value_above) {
    float t = above;
    for (int i = 0; i < 4; ++i) {
        t = mix(below, above, clamp(value_below / min(value_below - value_above, -1e-20), 0.0, 1.0));
        float value = nacre_volume_above(volume, iso, from + t * along);
        if (value >= 0.0) {
            above = t;
            value_above = value;
            value_below *= 0.5;
        } else {
            below = t;
            value_below = value;
            value_above *= 0.5;
        }
    }
    return t;
}

// The first t in [0, 1] where the ray meets the surface, looked for in steps of `part`; 2 when it misses. A ray that
// starts or enters the box inside the surface meets it there. At most 4096 steps.
float nacre_volume_march(sampler3D volume, float iso, vec3 from, vec3 along, float part) {
    vec2 span = nacre_volume_span(from, along);
    if (span.x >= span.y) return 2.0;
    float before = span.x, value_before = nacre_volume_above(volume, iso, from + before * along);
    if (value_before >= 0.0) return before;
    float t = before;
    for (int i = 0; i < 4096; ++i) {
        if (t >= span.y) break;
        t = min(t + part, span.y);
        float value = nacre_volume_above(volume, iso, from + t * along);
        if (value >= 0.0) return nacre_volume_crossing(volume, iso, from, along, before, t, value_before, value);
        before = t;
        value_before = value;
    }
    return 2.0;
}

#endif
