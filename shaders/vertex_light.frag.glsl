// Back faces are black: vertices that belong to them alone aren't computed.
in vec3 v_radiance;

out vec4 color;

void main() {
    color = vec4(gl_FrontFacing ? v_radiance : vec3(0.0), 1.0);
}
