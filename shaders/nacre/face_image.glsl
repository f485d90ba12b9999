// Pictures on specular faces, as parts of one texture.
#ifndef NACRE_FACE_IMAGE_GLSL
#define NACRE_FACE_IMAGE_GLSL

// Bilinear between texel centres, clamped at the part's edges. rect: x, y, width, height [texels]. C++: sampleBilinear
// (core/image.hpp), to 1e-5.
vec4 nacre_face_image(sampler2D images, vec4 rect, vec2 uv) {
    vec2 t = clamp(uv * rect.zw - 0.5, vec2(0.0), rect.zw - 1.0);
    vec2 low = floor(t);
    t -= low;
    ivec2 a = ivec2(rect.xy + low);
    ivec2 b = ivec2(rect.xy + min(low + 1.0, rect.zw - 1.0));
    vec4 first = mix(texelFetch(images, a, 0), texelFetch(images, ivec2(b.x, a.y), 0), t.x);
    vec4 second = mix(texelFetch(images, ivec2(a.x, b.y), 0), texelFetch(images, b, 0), t.x);
    return mix(first, second, t.y);
}

#endif
