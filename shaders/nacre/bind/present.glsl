// A picture on its way to the window. C++: Presenter (demos/viewer/present.cpp).
#ifndef NACRE_BIND_PRESENT_GLSL
#define NACRE_BIND_PRESENT_GLSL

uniform sampler2D nacre_present_picture;
uniform vec4 nacre_present_area;  // texture coordinates = xy + zw * window pixels
uniform float nacre_present_white;

#endif
