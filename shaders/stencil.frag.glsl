// What counts alone: stencil and depth tests see it, no colour is written. C++: ShadowStencil
// (shading/multipass/shadow_stencil.hpp).
void main() {}
