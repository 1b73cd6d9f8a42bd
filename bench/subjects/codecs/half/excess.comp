#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
// Whether a product keeps more digits than a half has, until it is stored: x x - y for x = 1 + 2^-10, y = 1 + 2^-9 is 0
// where every step is rounded, and 2^-20 where it is not.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 1) readonly buffer Views { vec4 views[]; };
layout(std430, binding = 2) buffer Made { vec4 made[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= given.length()) return;
    f16vec4 x = f16vec4(given[i]), y = f16vec4(views[i]);
    made[i] = vec4(x * x - y);
}
