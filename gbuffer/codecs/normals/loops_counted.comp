#version 430
// How often each loop of an encoder, and of a decoder, runs its body. loops.py writes one of these two functions around
// each loop's condition: before the body `next_turn`, behind it (do while) `turn_made`.
int counted_turns[MOST_LOOPS];
bool next_turn(int loop, bool again) {
    counted_turns[loop] += again ? 1 : 0;
    return again;
}
bool turn_made(int loop, bool again) {
    ++counted_turns[loop];
    return again;
}
#include "code.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 1) readonly buffer Views { vec4 views[]; };
layout(std430, binding = 2) writeonly buffer Turns { vec4 turns[]; };
layout(std430, binding = 3) writeonly buffer Made { vec4 made[]; };

int asked_loop;

int taken_turns() {
    int taken = counted_turns[asked_loop];
    counted_turns[asked_loop] = 0;
    return taken;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= normals.length()) return;
    asked_loop = int(normals[i].w);
    counted_turns[asked_loop] = 0;
    vec3 view = views[i].xyz;
    CODE code = encoded(direction_or_forward(normals[i].xyz), view, float[](KERNEL_SCALE, KERNEL_SCALE, KERNEL_SCALE), true);
    int encoding = taken_turns();
    vec3 n = DECODE(code, view);
    turns[i] = vec4(float(encoding), float(taken_turns()), 0.0, 0.0);
    // What is not used would not be computed.
    made[i] = vec4(n, code.x + code.y);
}
