// A volume in use. C++: renderVolume (shading/volume_pass.cpp).
#ifndef NACRE_BIND_VOLUME_GLSL
#define NACRE_BIND_VOLUME_GLSL

#include "nacre/bind/view.glsl"
#include "nacre/volume.glsl"

uniform sampler3D nacre_volume;        // rgb: gradient in the volume's own space, of any length; a: value
uniform float nacre_volume_iso;        // in the texture's units
uniform float nacre_volume_step;       // of a march [world units]
uniform mat4 nacre_volume_from_world;  // to texture coordinates
uniform mat3 nacre_volume_normal;      // own space to world, for normals

// The end of the line of sight from `near` to `far` (world): x = the part of it that is free, 2 when all is.
float nacre_volume_sight(vec3 near, vec3 far) {
    vec3 from = (nacre_volume_from_world * vec4(near, 1.0)).xyz;
    vec3 along = mat3(nacre_volume_from_world) * (far - near);
    return nacre_volume_march(nacre_volume, nacre_volume_iso, from, along, nacre_volume_step / length(far - near));
}

bool nacre_volume_inside(vec3 position) {
    return nacre_volume_above(nacre_volume, nacre_volume_iso, (nacre_volume_from_world * vec4(position, 1.0)).xyz) >= 0.0;
}

// Away from the inside, unit; to_eye where the field is flat.
vec3 nacre_volume_outward(vec3 position, vec3 to_eye) {
    vec3 at = (nacre_volume_from_world * vec4(position, 1.0)).xyz;
    vec3 outward = -(nacre_volume_normal * textureLod(nacre_volume, at, 0.0).rgb);
    float size = dot(outward, outward);
    return size > 1e-20 ? outward * inversesqrt(size) : to_eye;
}

#endif
