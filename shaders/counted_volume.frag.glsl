// 1 where a ray enters a shadow volume, -1 where it leaves it: the s-count (HYBRID section 2).
out vec4 color;

void main() { color = vec4(gl_FrontFacing ? 1.0 : -1.0); }
