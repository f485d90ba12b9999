// Place, normal and albedo of what a pixel shows. Back faces and specular surfaces reflect nothing diffusely.
#include "nacre/bind/geometry.glsl"
#include "nacre/bind/shadows.glsl"
#include "nacre/bind/view.glsl"

in vec3 v_position;
in vec3 v_normal;

layout(location = 0) out vec4 place;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 albedo;

void main() {
    vec3 n = normalize(v_normal);
    vec3 to_eye = nacre_eye.xyz - nacre_eye.w * v_position;
    bool reflects = nacre_geometry_specular == 0.0 && dot(n, to_eye) > 0.0;
    place = vec4(v_position, nacre_geometry_surface.w);
    normal = vec4(n, nacre_geometry_specular);
    vec3 facet = nacre_shadow_normal(v_position, normalize(to_eye));
    albedo = vec4(reflects ? nacre_geometry_surface.rgb : vec3(0.0), nacre_geometry_packed(facet));
}
