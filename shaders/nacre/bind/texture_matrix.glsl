// The texture matrices of HSE section 1.1, equations 2 and 3. C++: shading/texture_matrix.hpp.
#ifndef NACRE_BIND_TEXTURE_MATRIX_GLSL
#define NACRE_BIND_TEXTURE_MATRIX_GLSL

uniform mat4 nacre_matrix_half;        // eq. 2: (n, 1) -> (cos theta_d, cos delta, 0, 1)
uniform mat4 nacre_matrix_light_view;  // eq. 3: (n, 1) -> (cos alpha, cos beta, 0, 1); of the tangent for Banks' form

#endif
