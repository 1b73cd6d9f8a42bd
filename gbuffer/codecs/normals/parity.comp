#version 430
// Encoder and decoder without any storage: the exact values that the two languages are compared by.
#include "code.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 1) readonly buffer Views { vec4 views[]; };
layout(std430, binding = 2) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 3) writeonly buffer Codes { vec4 codes[]; };
layout(std430, binding = 4) writeonly buffer Decoded { vec4 decoded[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= normals.length()) return;
    vec3 view = views[i].xyz;
    codes[i] = widen(ENCODE(direction_or_forward(normals[i].xyz), view));
    decoded[i] = vec4(DECODE(CODE(given[i]), view), 0.0);
}
