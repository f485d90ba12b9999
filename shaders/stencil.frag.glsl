// What counts alone: stencil and depth tests see it, no colour is written. #define NACRE_STENCIL_CUT: of a mesh what is
// in front of its cuts. C++: ShadowStencil (shading/multipass/shadow_stencil.hpp).
#ifdef NACRE_STENCIL_CUT
in vec2 v_before_cuts;
#endif

void main() {
#ifdef NACRE_STENCIL_CUT
    if (min(v_before_cuts.x, v_before_cuts.y) < 0.0) discard;
#endif
}
