#version 430
// Feeds kernel.frag numbers that no compiler can tell apart from any others.
layout(std430, binding = PLANES) buffer KernelPlanes { float kernel_planes[][GROUP]; };
layout(location = 0) out GIVEN kernel_given;
layout(location = 1) out BESIDE kernel_beside;

void main() {
    gl_Position = vec4(kernel_planes[0][gl_VertexIndex]);
    for (int i = 0; i < kernel_given.length(); ++i) kernel_given[i] = kernel_planes[1 + i][gl_VertexIndex];
    for (int i = 0; i < kernel_beside.length(); ++i) kernel_beside[i] = kernel_planes[5 + i][gl_VertexIndex];
}
