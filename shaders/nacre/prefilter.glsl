// Prefiltering at run time: a lobe summed over the texels of a cube that lies as a strip of six faces, one below the
// other (core/environment.hpp's Cube), halved level by level. Near the lobe's axis fine levels are read, farther out
// coarser ones, so that a texel is always the same share of the angle: a few hundred texels an octave, whatever the lobe.
// C++: shading/gpu_prefilter.cpp; values against nacre::prefilter (envmaps/prefilter.hpp) in
// tests/shading/gpu_prefilter_test.cpp.
#ifndef NACRE_PREFILTER_GLSL
#define NACRE_PREFILTER_GLSL

// Columns: the directions of s (right), t (down) and the face's middle. Twin: kFaces of core/environment.cpp.
mat3 nacre_prefilter_axes(int face) {
    if (face == 0) return mat3(0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0);
    if (face == 1) return mat3(0.0, 0.0, -1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0);
    if (face == 2) return mat3(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    if (face == 3) return mat3(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0);
    if (face == 4) return mat3(-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0);
    return mat3(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0);
}

// Unit direction of a texel of the strip. Twin: envTexelDirection, to rounding.
vec3 nacre_prefilter_direction(ivec2 texel, int edge) {
    int face = texel.y / edge;
    vec2 st = (vec2(texel.x, texel.y - face * edge) + 0.5) * (2.0 / float(edge)) - 1.0;
    return normalize(nacre_prefilter_axes(face) * vec3(st, 1.0));
}

// The strip's texel that holds a direction.
ivec2 nacre_prefilter_texel(vec3 d, int edge) {
    vec3 a = abs(d);
    int face = a.x >= a.y && a.x >= a.z ? (d.x >= 0.0 ? 0 : 1) : a.y >= a.z ? (d.y >= 0.0 ? 2 : 3) : (d.z >= 0.0 ? 4 : 5);
    vec3 q = d * nacre_prefilter_axes(face);
    ivec2 at = ivec2((q.xy / q.z + 1.0) * (0.5 * float(edge)));
    return clamp(at, ivec2(0), ivec2(edge - 1)) + ivec2(0, face * edge);
}

// Solid angle of the texel around (s, t) of edge h in a face's plane [sr]: the integrand (1 + s^2 + t^2)^(-3/2) in the
// middle and its second derivatives. The closed form's differences would drown in single precision. Twin:
// envSolidAngle, 3e-4 relative from 8 texels an edge, 1e-6 from 32.
float nacre_prefilter_solid_angle(vec2 st, float h) {
    float inverse = 1.0 / (1.0 + dot(st, st));
    return h * h * inverse * sqrt(inverse) * (1.0 + h * h / 24.0 * inverse * (9.0 - 15.0 * inverse));
}

// Where in its texel the light is, from (0, 0) to (1, 1), in one number that a float holds exactly: a lamp smaller than
// a coarse texel is summed from its own direction, not from the texel's middle.
float nacre_prefilter_pack(vec2 place) {
    vec2 steps = floor(clamp(place, 0.0, 1.0) * 4094.0 + 0.5);  // 4094: the middle is a step
    return steps.x * 4096.0 + steps.y;
}
vec2 nacre_prefilter_unpack(float packed_place) {
    float x = floor(packed_place / 4096.0);
    return vec2(x, packed_place - x * 4096.0) / 4094.0;
}

// Lobes by the squared chord c = |r - l|^2 between axis and light, which keeps what 1 - cos loses near the axis. Twin:
// zonalKernel (envmaps/lobes.hpp), 2e-5 of the lobe's largest value.
float nacre_prefilter_cosine(float c) { return max(0.0, 1.0 - 0.5 * c); }

float nacre_prefilter_phong(float c, float exponent) {
    float x = 0.5 * c;
    if (x >= 1.0) return 0.0;
    // ln(1 - x), by its series where 1 - x would round
    float logarithm = x < 0.02 ? -x * (1.0 + x * (0.5 + x * (1.0 / 3.0 + 0.25 * x))) : log(1.0 - x);
    return exp(exponent * logarithm);
}

float nacre_prefilter_ggx(float c, float alpha) {
    float sin2 = 0.25 * c;
    float d = 1.0 / (1.0 - sin2 + sin2 / (alpha * alpha));
    return d * d * nacre_prefilter_cosine(c);
}

float nacre_prefilter_beckmann(float c, float alpha) {
    float sin2 = 0.25 * c;
    float cos2 = 1.0 - sin2;
    if (c >= 2.0) return 0.0;
    return exp(-sin2 / (cos2 * alpha * alpha)) / (cos2 * cos2) * nacre_prefilter_cosine(c);
}

// Refraction: bend = 1 - 1/ior, not 0. zonalKernel's q^4 cancels against the distribution's, and what is left has no difference
// of near numbers however close ior is to 1. 0 beyond the grazing facet (s) or total reflection (t).
float nacre_prefilter_ggx_refraction(float c, float alpha, float bend) {
    float s = 1.0 - 0.5 * c / bend, t = 1.0 + (1.0 - bend) * (0.5 * c / bend);
    if (s <= 0.0 || t <= 0.0) return 0.0;
    float width = alpha * bend;
    float d = 1.0 / (s * s + c * (1.0 - 0.25 * c) / (width * width));
    return d * d * s * t * nacre_prefilter_cosine(c);
}

float nacre_prefilter_beckmann_refraction(float c, float alpha, float bend) {
    float s = 1.0 - 0.5 * c / bend, t = 1.0 + (1.0 - bend) * (0.5 * c / bend);
    if (s <= 0.0 || t <= 0.0) return 0.0;
    float width = alpha * bend * s;
    return exp(-c * (1.0 - 0.25 * c) / (width * width)) / (s * s * s) * t * nacre_prefilter_cosine(c);
}

// `slopes`: the square of ((l - r).x / alpha, (l - r).y / alphaY), x along the tangent and y across. Twin:
// filterAnisotropic (envmaps/anisotropic_filter.hpp), 2e-5; its (l.x, l.y) is this, as r has no part along x or y.
float nacre_prefilter_ggx_anisotropic(float c, float slopes) {
    float up = 2.0 - 0.5 * c;
    float d = (4.0 - c) / (slopes + up * up);
    return d * d * nacre_prefilter_cosine(c);
}

// The axis without its part along r. Twin: lobeTangent, to rounding over the sine between them; where that is
// below it both take the same other.
vec3 nacre_prefilter_tangent(vec3 axis, vec3 r) {
    vec3 t = axis - dot(axis, r) * r;
    if (dot(t, t) < 1e-12) t = cross(r, abs(r.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0));
    return normalize(t);
}

#define NACRE_PREFILTER_MIRROR 0
#define NACRE_PREFILTER_DIFFUSE 1
#define NACRE_PREFILTER_PHONG 2
#define NACRE_PREFILTER_GGX 3
#define NACRE_PREFILTER_BECKMANN 4
#define NACRE_PREFILTER_GGX_REFRACTION 5
#define NACRE_PREFILTER_BECKMANN_REFRACTION 6
#define NACRE_PREFILTER_GGX_ANISOTROPIC 7
#ifndef NACRE_PREFILTER_LOBE
#define NACRE_PREFILTER_LOBE NACRE_PREFILTER_DIFFUSE
#endif

// The zonal ones; `second` as in NacrePrefilterPlan.
float nacre_prefilter_lobe(float c, float parameter, float second) {
#if NACRE_PREFILTER_LOBE == NACRE_PREFILTER_PHONG
    return nacre_prefilter_phong(c, parameter);
#elif NACRE_PREFILTER_LOBE == NACRE_PREFILTER_GGX
    return nacre_prefilter_ggx(c, parameter);
#elif NACRE_PREFILTER_LOBE == NACRE_PREFILTER_BECKMANN
    return nacre_prefilter_beckmann(c, parameter);
#elif NACRE_PREFILTER_LOBE == NACRE_PREFILTER_GGX_REFRACTION
    return nacre_prefilter_ggx_refraction(c, parameter, second);
#elif NACRE_PREFILTER_LOBE == NACRE_PREFILTER_BECKMANN_REFRACTION
    return nacre_prefilter_beckmann_refraction(c, parameter, second);
#else
    return nacre_prefilter_cosine(c);
#endif
}

// The part of a face's line [-1, 1] under a cone about an axis that the line's plane sees at (along, middle): tangent
// planes stand asin(sin / length) on both sides of the axis' projection. x > y: nothing.
vec2 nacre_prefilter_shadow(float along, float middle, float coneSin) {
    float reach = length(vec2(along, middle));
    if (coneSin >= reach) return vec2(-1.0, 1.0);
    float at = atan(along, middle), half_angle = asin(coneSin / reach);
    const float kEdge = 0.78539816;
    return tan(clamp(vec2(at - half_angle, at + half_angle), -kEdge, kEdge)) +
           (at - half_angle > kEdge || at + half_angle < -kEdge ? vec2(4.0, -4.0) : vec2(0.0));
}

// What one sum needs. Level k has texels of about h 2^k radians; an angle is summed on the level
// log2(max(angle, width) / (detail h)), between two levels by shares of both. An anisotropic lobe's angle is counted in
// the narrower direction: its levels meet in ellipses.
struct NacrePrefilterPlan {
    int edge;         // of level 0 [texels]
    int first, last;  // levels that take part
    float parameter;  // exponent or alpha
    float width;      // chord within which the lobe doesn't change much
    float support;    // chord beyond which it is left out
    float detail;     // texels a width
    float second;     // refraction: 1 - 1/ior; anisotropic: alpha across the tangent
    vec3 axis;        // anisotropic: unit, see nacre_prefilter_tangent
};

// \param distance2  square of the chord or, anisotropic, of the one in the narrower direction
float nacre_prefilter_share(NacrePrefilterPlan plan, float distance2, int level) {
    float place = log2(max(sqrt(distance2), plan.width) * float(plan.edge) / (2.0 * plan.detail));
    float gap = abs(clamp(place, float(plan.first), float(plan.last)) - float(level));
    return max(0.0, 1.0 - gap);
}

// The part of a face's row [-1, 1] at height t where the square of a place's (x, y) is at most `slopes` times that of its
// length: a s^2 + 2 b s + c <= 0 for the place (s, t, 1), so between two roots or, where the ellipse is longer than a
// hemisphere (a < 0), outside them. x > y: nothing.
vec2 nacre_prefilter_row(vec3 x, vec3 y, float slopes, float t) {
    vec2 u = vec2(x.y * t + x.z, y.y * t + y.z), first = vec2(x.x, y.x);
    float a = dot(first, first) - slopes, b = dot(first, u), c = dot(u, u) - slopes * (t * t + 1.0);
    float inside = b * b - a * c;
    if (a == 0.0 || inside < 0.0) return a > 0.0 ? vec2(4.0, -4.0) : vec2(-1.0, 1.0);
    vec2 roots = (vec2(-1.0, 1.0) * sqrt(inside) - b) / a;
    if (a > 0.0) return clamp(roots, vec2(-1.0, -4.0), vec2(4.0, 1.0));
    return vec2(roots.y <= -1.0 ? max(roots.x, -1.0) : -1.0, roots.x >= 1.0 ? min(roots.y, 1.0) : 1.0);
}

// Sum w L and sum w over the texels of one face of one level, in the strip's rows from rows.x to before rows.y.
vec4 nacre_prefilter_face(sampler2D strip, NacrePrefilterPlan plan, vec3 r, int level, int face, ivec2 rows) {
    int edge = plan.edge >> level;
    float h = 2.0 / float(edge);
    float reach = level == plan.last ? 2.0 : 2.0 * plan.detail * h;
    vec3 q = r * nacre_prefilter_axes(face);
#if NACRE_PREFILTER_LOBE == NACRE_PREFILTER_GGX_ANISOTROPIC
    vec3 tangent = nacre_prefilter_tangent(plan.axis, r);
    vec3 x_axis = tangent * nacre_prefilter_axes(face) / plan.parameter;
    vec3 y_axis = cross(r, tangent) * nacre_prefilter_axes(face) / plan.second;
    float narrow = min(plan.parameter, plan.second);
    float slopes_end = (reach + h) / narrow * ((reach + h) / narrow);  // h: a lamp may be anywhere in its texel
    reach *= max(plan.parameter, plan.second) / narrow;
#endif
    reach = min(reach, plan.support);
    float coneSin = reach >= 1.4142 ? 2.0 : reach * sqrt(1.0 - 0.25 * reach * reach);  // chord to sine; 2: no cone
    // A face reaches 54.7 degrees from its middle.
    if (q.z < cos(min(0.956 + 2.0 * asin(min(0.5 * reach, 1.0)), 3.1416))) return vec4(0.0);
    vec2 across = nacre_prefilter_shadow(q.x, q.z, coneSin), down = nacre_prefilter_shadow(q.y, q.z, coneSin);
    if (across.x > across.y || down.x > down.y) return vec4(0.0);
    ivec2 low = ivec2(max((vec2(across.x, down.x) + 1.0) / h - 0.5, 0.0));
    ivec2 high = min(ivec2((vec2(across.y, down.y) + 1.0) / h + 0.5), ivec2(edge - 1));
    low.y = max(low.y, rows.x - face * edge), high.y = min(high.y, rows.y - face * edge - 1);
    vec4 sum = vec4(0.0);
    for (int y = low.y; y <= high.y; ++y) {
        int left = low.x, right = high.x;
#if NACRE_PREFILTER_LOBE == NACRE_PREFILTER_GGX_ANISOTROPIC
        vec2 row = nacre_prefilter_row(x_axis, y_axis, slopes_end, (float(y) + 0.5) * h - 1.0);
        if (row.x > row.y) continue;
        left = max(left, int((row.x + 1.0) / h - 0.5)), right = min(right, int((row.y + 1.0) / h + 0.5));
#endif
        for (int x = left; x <= right; ++x) {
            vec4 texel = texelFetch(strip, ivec2(x, y + face * edge), level);
            vec2 st = (vec2(x, y) + nacre_prefilter_unpack(texel.a)) * h - 1.0;
            vec3 gap = vec3(st, 1.0) * inversesqrt(1.0 + dot(st, st)) - q;
            float c = dot(gap, gap);
            if (c > reach * reach) continue;
            st = (vec2(x, y) + 0.5) * h - 1.0;
#if NACRE_PREFILTER_LOBE == NACRE_PREFILTER_GGX_ANISOTROPIC
            vec2 slope = vec2(dot(gap, x_axis), dot(gap, y_axis));
            float slopes = dot(slope, slope);
            float weight = nacre_prefilter_ggx_anisotropic(c, slopes) *
                           nacre_prefilter_share(plan, narrow * narrow * slopes / (1.0 - 0.25 * c), level);
#else
            float weight = nacre_prefilter_lobe(c, plan.parameter, plan.second) * nacre_prefilter_share(plan, c, level);
#endif
            sum += weight * nacre_prefilter_solid_angle(st, h) * vec4(texel.rgb, 1.0);
        }
    }
    return sum;
}

// The part of a sum that lies in levels part.x to part.y and the strip's rows from part.z to before part.w.
vec4 nacre_prefilter_sum(sampler2D strip, NacrePrefilterPlan plan, vec3 r, ivec4 part) {
    vec4 sum = vec4(0.0);
    for (int level = part.x; level <= part.y; ++level)
        for (int face = 0; face < 6; ++face) sum += nacre_prefilter_face(strip, plan, r, level, face, part.zw);
    return sum;
}

// A texel of the next coarser level: four of the level that `strip` shows as its base, weighted by solid angle; alpha is
// their light's place.
vec4 nacre_prefilter_halved(sampler2D strip, ivec2 texel, int edge) {
    vec4 sum = vec4(0.0);
    vec3 place = vec3(0.0);  // Sum of light times (place, 1)
    int fine = 2 * edge, face = texel.y / edge;
    for (int i = 0; i < 4; ++i) {
        ivec2 child = ivec2(i - 2 * (i / 2), i / 2), at = 2 * texel + child;
        float h = 2.0 / float(fine);
        vec2 st = (vec2(at.x, at.y - face * fine) + 0.5) * h - 1.0;
        vec4 value = texelFetch(strip, at, 0);
        float solidAngle = nacre_prefilter_solid_angle(st, h);
        sum += solidAngle * vec4(value.rgb, 1.0);
        float light = solidAngle * max(0.0, value.r + value.g + value.b);
        place += light * vec3(0.5 * (vec2(child) + nacre_prefilter_unpack(value.a)), 1.0);
    }
    vec2 middle = place.z > 0.0 ? place.xy / place.z : vec2(0.5);
    return vec4(sum.rgb / sum.a, nacre_prefilter_pack(middle));
}

#endif
