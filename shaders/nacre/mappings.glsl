// Where a direction pair falls in a factored BRDF's textures. C++ twins, with the derivations: factorize/mappings.hpp
// (the functions of the same names); both in single precision, so that lookups agree to rounding.
#ifndef NACRE_MAPPINGS_GLSL
#define NACRE_MAPPINGS_GLSL

struct NacreHalfGeometry {
    vec3 h;             // unit half vector
    float lengthXY;     // |(hx, hy)| = sin theta_h
    float oneMinusLh;   // 1 - l.h = |l - h|^2 / 2
};

NacreHalfGeometry nacre_half_geometry(vec3 wi, vec3 wo) {
    NacreHalfGeometry g;
    vec3 sum = wi + wo;
    g.h = sum / max(length(sum), 1e-6);
    g.lengthXY = length(g.h.xy);
    vec3 gap = wi - g.h;
    g.oneMinusLh = min(0.5 * dot(gap, gap), 1.0);
    return g;
}

// half_diff: (sqrt(t/(t+s)), sqrt(1 - l.h)), t = tan theta_h
vec2 nacre_map_half_diff(NacreHalfGeometry g, float s) {
    float t = g.lengthXY / max(g.h.z, 1e-6);
    return vec2(sqrt(t / (t + s)), sqrt(g.oneMinusLh));
}

float nacre_cos_squared_phi_d(NacreHalfGeometry g, vec3 wi, vec3 wo) {
    float gap = wi.z - wo.z;
    float sinSquareD = g.oneMinusLh * (2.0 - g.oneMinusLh);
    float denominator = max(4.0 * g.lengthXY * g.lengthXY * sinSquareD, 1e-4);
    return clamp(gap * gap / denominator, 0.0, 1.0);
}

// elevations: U = sqrt(1 - min), V = sqrt(1 - max) / U
vec2 nacre_map_elevations(float cosI, float cosO) {
    float u = sqrt(clamp(1.0 - min(cosI, cosO), 0.0, 1.0));
    float v = sqrt(clamp(1.0 - max(cosI, cosO), 0.0, 1.0));
    return vec2(u, min(v / max(u, 1e-4), 1.0));
}

vec2 nacre_fold_disk(vec2 p, bool quadrant) {
    return quadrant ? min(abs(p), vec2(1.0)) : clamp(0.5 * p + 0.5, 0.0, 1.0);
}

// scaled_slope: half vector's slopes over their widths on the unit disk
vec2 nacre_map_scaled_slope(vec3 h, vec2 inverseWidth, bool quadrant) {
    vec2 m = h.xy * inverseWidth / max(h.z, 1e-6);
    float size = length(m);
    return nacre_fold_disk(m / sqrt(max(size, 1e-20) * (size + 1.5)), quadrant);
}

// lambert_disk: direction on the equal-area disk
vec2 nacre_map_lambert_disk(vec3 w, bool quadrant) {
    return nacre_fold_disk(w.xy / sqrt(1.0 + max(w.z, 0.0)), quadrant);
}

// lobe: from 1 - s
float nacre_map_lobe(float oneMinusS, float w0) {
    float w = sqrt(clamp(oneMinusS, 0.0, 1.0));
    return w / (w + w0) * (1.0 + w0);
}

// tangent: ((1 + t.l)/2, (1 + t.v)/2)
vec2 nacre_map_tangent(float tDotL, float tDotV) {
    return clamp(0.5 * vec2(tDotL, tDotV) + 0.5, 0.0, 1.0);
}

// wi in the half vector's frame
vec3 nacre_difference_vector(vec3 h, vec3 wi) {
    float sinH = length(h.xy);
    vec2 azimuth = sinH > 1e-6 ? h.xy / sinH : vec2(1.0, 0.0);
    vec3 x = vec3(azimuth * h.z, -sinH);
    vec3 y = vec3(-azimuth.y, azimuth.x, 0.0);
    return vec3(dot(wi, x), dot(wi, y), dot(wi, h));
}

// wi turned by the smallest rotation that takes h to the normal
vec3 nacre_carried_difference(vec3 h, vec3 wi) {
    float cosD = dot(wi, h);
    return vec3(wi.xy - (cosD + wi.z) / (1.0 + h.z) * h.xy, cosD);
}

float nacre_smith_denominator(float shadowing, vec2 width, vec3 wi, vec3 wo) {
    if (shadowing < 0.5) return 1.0;
    vec3 scale = vec3(width, 1.0);
    float si = length(scale * wi);
    float so = length(scale * wo);
    return shadowing < 1.5 ? wo.z * si + wi.z * so : (wi.z + si) * (wo.z + so);
}

// A mapping's value looked up: 0 is the centre of the first texel, 1 of the last; then the stored range.
vec4 nacre_lookup(sampler2D tex, vec2 uv, vec4 scale, vec4 bias) {
    vec2 size = vec2(textureSize(tex, 0));
    return bias + scale * textureLod(tex, (uv * (size - 1.0) + 0.5) / size, 0.0);
}

// e^60: no BRDF reaches it, and squares of it stay finite
vec3 nacre_exp(vec3 y) { return exp(min(y, vec3(60.0))); }

#endif
