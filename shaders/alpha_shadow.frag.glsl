// One texture or both. NACRE_ALPHA_STEP: _RAMP, alpha by depth; _MAP, alpha by the projected map; _TEST, their
// difference, and only fragments with 0 live on (the alpha test).
#include "nacre/alpha_shadow.glsl"
#include "nacre/bind/alpha_shadow.glsl"

#define NACRE_ALPHA_RAMP 0
#define NACRE_ALPHA_MAP 1
#define NACRE_ALPHA_TEST 2

in float v_depth;
in vec4 v_place;

out vec4 color;

void main() {
    float alpha = 0.0;
#if NACRE_ALPHA_STEP != NACRE_ALPHA_MAP
    alpha = nacre_alpha_ramp(nacre_alpha_ramp_texture, v_depth, nacre_alpha_steps);
#endif
#if NACRE_ALPHA_STEP == NACRE_ALPHA_MAP
    alpha = nacre_alpha_projected(nacre_alpha_map, v_place);
#endif
#if NACRE_ALPHA_STEP == NACRE_ALPHA_TEST
    alpha = nacre_alpha_difference(alpha, nacre_alpha_projected(nacre_alpha_map, v_place));
    if (alpha > 0.0) discard;
#endif
    color = vec4(0.0, 0.0, 0.0, alpha);
}
