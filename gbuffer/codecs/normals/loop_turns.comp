#version 430
// How many turns the device makes of a loop that nothing stands before.
#include "loop_turns.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 1) writeonly buffer Made { vec4 made[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < given.length()) made[i] = vec4(float(turns_made()));
}
