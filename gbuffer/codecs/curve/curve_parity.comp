#version 430
// A curve and its way back without any storage: the exact values that the two languages are compared by.
#include "vec.glsl"
#include CURVE_ENCODING

uniform float range;
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { vec4 given[]; };  // two quantities, and two numbers to decode
layout(std430, binding = 1) writeonly buffer Found { vec4 found[]; };  // the numbers, and the quantities

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= given.length()) return;
    vec4 g = given[i];
    found[i] = vec4(CURVE_ENCODE(g.x, range), CURVE_ENCODE(g.y, range), CURVE_DECODE(g.z, range),
                    CURVE_DECODE(g.w, range));
}
