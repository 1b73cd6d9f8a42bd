#version 430
// Feeds kernel.frag numbers that no compiler can tell apart from any others.
layout(std430, binding = PLANES) buffer Planes { float planes[][GROUP]; };
layout(location = 0) out GIVEN given;
layout(location = 1) out BESIDE beside;

void main() {
    gl_Position = vec4(planes[0][gl_VertexIndex]);
    for (int i = 0; i < given.length(); ++i) given[i] = planes[1 + i][gl_VertexIndex];
    for (int i = 0; i < beside.length(); ++i) beside[i] = planes[5 + i][gl_VertexIndex];
}
