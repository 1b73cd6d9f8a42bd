#version 430
// Feeds kernel_bare.frag numbers that no compiler can tell apart from any others, without a buffer: older GPUs have none.
layout(location = 0) in GIVEN kernel_numbers;
layout(location = 1) in BESIDE kernel_numbers_beside;
layout(location = 0) out GIVEN kernel_given;
layout(location = 1) out BESIDE kernel_beside;

void main() {
    gl_Position = vec4(kernel_numbers_beside.xy, 0.0, 1.0);
    kernel_given = kernel_numbers;
    kernel_beside = kernel_numbers_beside;
}
