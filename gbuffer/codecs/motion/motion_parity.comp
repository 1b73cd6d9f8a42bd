#version 430
// Motion encoder and decoder without any storage: the exact values that the two languages are compared by.
#include "motion_code.glsl"

uniform float range;
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { vec4 given[]; };  // a motion, and a code to decode
layout(std430, binding = 1) writeonly buffer Found { vec4 found[]; };  // the code, and the motion

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= given.length()) return;
    found[i] = vec4(code_of_motion(given[i].xy, range), motion_of_code(given[i].zw, range));
}
