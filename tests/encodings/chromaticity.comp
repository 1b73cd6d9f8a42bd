#version 430
// A highlight of each colour and luminance.
#include "chromaticity.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 1) writeonly buffer Found { vec4 found[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    found[i] = vec4(coloured(given[i].rgb, given[i].a), 0.0);
}
