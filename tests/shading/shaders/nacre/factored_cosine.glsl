// A stand-in for the tests of addressing, so that they don't hang on how the real form stores its tables: both are read
// linearly in their cosines, f = A(cos theta_d, cos delta) B(cos alpha, cos beta). The C++ side is in addressing_test.cpp.
#ifndef NACRE_FACTORED_COSINE_GLSL
#define NACRE_FACTORED_COSINE_GLSL

vec3 nacre_cosine_at(sampler2D t0, sampler2D t1, vec4 params[16], vec4 scale[4], vec4 bias[4], vec2 thetaDelta,
                     vec2 alphaBeta) {
    vec2 n0 = vec2(textureSize(t0, 0));
    vec2 n1 = vec2(textureSize(t1, 0));
    vec3 a = bias[0].rgb + scale[0].rgb * texture(t0, (thetaDelta * (n0 - 1.0) + 0.5) / n0).rgb;
    vec3 b = bias[1].rgb + scale[1].rgb * texture(t1, (alphaBeta * (n1 - 1.0) + 0.5) / n1).rgb;
    return params[0].rgb + a * b;
}

vec3 nacre_cosine(sampler2D t0, sampler2D t1, vec4 params[16], vec4 scale[4], vec4 bias[4], vec3 wi, vec3 wo) {
    vec3 h = normalize(wi + wo);
    return nacre_cosine_at(t0, t1, params, scale, bias, vec2(dot(h, wi), h.z), vec2(wi.z, wo.z));
}

#endif
