#version 430
// Light encoder and decoder without any storage: the exact values that the two languages are compared by.
#include "light_code.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Lights { vec4 lights[]; };
layout(std430, binding = 1) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 2) writeonly buffer Texels { vec4 texels[]; };
layout(std430, binding = 3) writeonly buffer Decoded { vec4 decoded[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= lights.length()) return;
    texels[i] = LIGHT_ENCODE(light_or_none(lights[i]));
    decoded[i] = LIGHT_DECODE(given[i]);
}
