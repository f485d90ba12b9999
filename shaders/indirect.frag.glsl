// Light of many virtual lights on what each pixel shows. Alpha: luminance that points would give more.
// #define NACRE_VIRTUAL_NEAR: how they look near by; NACRE_VIRTUAL_SHADOWS: with their shadow maps.
#include "nacre/bind/geometry.glsl"
#include "nacre/bind/virtual_lights.glsl"
#include "nacre/virtual_light.glsl"

out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 albedo = texelFetch(nacre_geometry_albedo, at, 0);
    vec3 place = texelFetch(nacre_geometry_place, at, 0).xyz;
    vec3 n = texelFetch(nacre_geometry_normal, at, 0).xyz;
    vec3 kept = vec3(0.0);
    vec3 whole = vec3(0.0);
    for (int i = 0; i < nacre_virtual_count; ++i) {
        vec3 light_normal = nacre_virtual_normal[i].xyz;
        vec4 u = nacre_virtual_u[i];
        vec4 v = nacre_virtual_v[i];
        vec4 middle = nacre_virtual_place[i];
        vec2 share = nacre_virtual_light(NACRE_VIRTUAL_NEAR, middle.xyz - place, n, light_normal, middle.w, u.xyz, v.xyz);
#ifdef NACRE_VIRTUAL_SHADOWS
        mat3 frame = nacre_virtual_frame(light_normal);
        vec3 q = (place - vec3(u.w, v.w, nacre_virtual_normal[i].w)) * frame;
        share *= nacre_virtual_lit(nacre_virtual_maps, nacre_virtual_layer + i, q, n * frame, nacre_virtual_drawn);
#endif
        kept += share.x * nacre_virtual_power[i].rgb;
        whole += share.y * nacre_virtual_power[i].rgb;
    }
    vec3 reflected = albedo.rgb * 0.31830989;
    color = vec4(reflected * kept, dot(reflected * (whole - kept), vec3(0.2126, 0.7152, 0.0722)));
}
