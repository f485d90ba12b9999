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
// zonalKernel (envmaps/lobes.hpp).
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

#define NACRE_PREFILTER_MIRROR 0
#define NACRE_PREFILTER_DIFFUSE 1
#define NACRE_PREFILTER_PHONG 2
#define NACRE_PREFILTER_GGX 3
#define NACRE_PREFILTER_BECKMANN 4
#ifndef NACRE_PREFILTER_LOBE
#define NACRE_PREFILTER_LOBE NACRE_PREFILTER_DIFFUSE
#endif

float nacre_prefilter_lobe(float c, float parameter) {
#if NACRE_PREFILTER_LOBE == NACRE_PREFILTER_PHONG
    return nacre_prefilter_phong(c, parameter);
#elif NACRE_PREFILTER_LOBE == NACRE_PREFILTER_GGX
    return nacre_prefilter_ggx(c, parameter);
#elif NACRE_PREFILTER_LOBE == NACRE_PREFILTER_BECKMANN
    return nacre_prefilter_beckmann(c, parameter);
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
// log2(max(angle, width) / (detail h)), between two levels by shares of both.
struct NacrePrefilterPlan {
    int edge;         // of level 0 [texels]
    int first, last;  // levels that take part
    float parameter;  // exponent or alpha
    float width;      // chord within which the lobe doesn't change much
    float support;    // chord beyond which it is left out
    float detail;     // texels a width
};

float nacre_prefilter_share(NacrePrefilterPlan plan, float c, int level) {
    float place = log2(max(sqrt(c), plan.width) * float(plan.edge) / (2.0 * plan.detail));
    float gap = abs(clamp(place, float(plan.first), float(plan.last)) - float(level));
    return max(0.0, 1.0 - gap);
}

// Sum w L and sum w over the texels of one face of one level.
vec4 nacre_prefilter_face(sampler2D strip, NacrePrefilterPlan plan, vec3 r, int level, int face) {
    int edge = plan.edge >> level;
    float h = 2.0 / float(edge);
    float reach = level == plan.last ? plan.support : min(plan.support, 2.0 * plan.detail * h);
    float coneSin = reach >= 1.4142 ? 2.0 : reach * sqrt(1.0 - 0.25 * reach * reach);  // chord to sine; 2: no cone
    vec3 q = r * nacre_prefilter_axes(face);
    // A face reaches 54.7 degrees from its middle.
    if (q.z < cos(min(0.956 + 2.0 * asin(min(0.5 * reach, 1.0)), 3.1416))) return vec4(0.0);
    vec2 across = nacre_prefilter_shadow(q.x, q.z, coneSin), down = nacre_prefilter_shadow(q.y, q.z, coneSin);
    if (across.x > across.y || down.x > down.y) return vec4(0.0);
    ivec2 low = ivec2(max((vec2(across.x, down.x) + 1.0) / h - 0.5, 0.0));
    ivec2 high = min(ivec2((vec2(across.y, down.y) + 1.0) / h + 0.5), ivec2(edge - 1));
    vec4 sum = vec4(0.0);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            vec4 texel = texelFetch(strip, ivec2(x, y + face * edge), level);
            vec2 st = (vec2(x, y) + nacre_prefilter_unpack(texel.a)) * h - 1.0;
            vec3 gap = vec3(st, 1.0) * inversesqrt(1.0 + dot(st, st)) - q;
            float c = dot(gap, gap);
            if (c > reach * reach) continue;
            st = (vec2(x, y) + 0.5) * h - 1.0;
            float weight = nacre_prefilter_lobe(c, plan.parameter) * nacre_prefilter_share(plan, c, level) *
                           nacre_prefilter_solid_angle(st, h);
            sum += weight * vec4(texel.rgb, 1.0);
        }
    return sum;
}

vec4 nacre_prefilter_sum(sampler2D strip, NacrePrefilterPlan plan, vec3 r) {
    vec4 sum = vec4(0.0);
    for (int level = plan.first; level <= plan.last; ++level)
        for (int face = 0; face < 6; ++face) sum += nacre_prefilter_face(strip, plan, r, level, face);
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
