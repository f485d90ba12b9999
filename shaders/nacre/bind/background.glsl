// C++: SceneRenderer (shading/scene_renderer.cpp).
#ifndef NACRE_BIND_BACKGROUND_GLSL
#define NACRE_BIND_BACKGROUND_GLSL

uniform vec3 nacre_background;  // radiance

#endif
