#version 430
// Frame encoder and decoder without any storage: the exact values that the two languages are compared by.
#include "frame_code.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Normals { vec4 normals[]; };  // normal, hand
layout(std430, binding = 1) readonly buffer Tangents { vec4 tangents[]; };
layout(std430, binding = 2) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 3) writeonly buffer Codes { vec4 codes[]; };
layout(std430, binding = 4) writeonly buffer DecodedNormals { vec4 decoded_normals[]; };
layout(std430, binding = 5) writeonly buffer DecodedTangents { vec4 decoded_tangents[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= normals.length()) return;
    codes[i] = FRAME_ENCODE(frame_of(normals[i].xyz, tangents[i].xyz, normals[i].w), FRAME_LEAST);
    Frame frame = FRAME_DECODE(given[i], FRAME_LEAST);
    decoded_normals[i] = vec4(frame.normal, frame.hand);
    decoded_tangents[i] = vec4(frame.tangent, 0.0);
}
