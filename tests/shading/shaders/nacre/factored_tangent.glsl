// A stand-in for the tests of addressing: f = T(t.l, t.v), each from [-1, 1]. See factored_cosine.glsl here.
#ifndef NACRE_FACTORED_TANGENT_GLSL
#define NACRE_FACTORED_TANGENT_GLSL

vec3 nacre_tangent_at(sampler2D t0, vec4 params[16], vec4 scale[4], vec4 bias[4], vec2 along) {
    vec2 n = vec2(textureSize(t0, 0));
    return params[0].rgb + bias[0].rgb + scale[0].rgb * texture(t0, ((0.5 + 0.5 * along) * (n - 1.0) + 0.5) / n).rgb;
}

vec3 nacre_tangent(sampler2D t0, vec4 params[16], vec4 scale[4], vec4 bias[4], vec3 wi, vec3 wo) {
    return nacre_tangent_at(t0, params, scale, bias, vec2(wi.x, wo.x));
}

#endif
