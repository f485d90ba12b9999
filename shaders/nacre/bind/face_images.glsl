// The pictures of a scene's specular faces (faceImages, shading/multipass/face_image.hpp): rgb of filters, alpha of
// textures.
#ifndef NACRE_BIND_FACE_IMAGES_GLSL
#define NACRE_BIND_FACE_IMAGES_GLSL

#include "nacre/face_image.glsl"

uniform sampler2D nacre_face_images;

#endif
