#version 430
// 1 where the loops of an encoder, and of a decoder, were done; another number, or none at all, where the device has ended
// one of them.
#include "loop_turns.glsl"
#include "code.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 1) readonly buffer Views { vec4 views[]; };
layout(std430, binding = 2) writeonly buffer Encoding { vec4 encoding[]; };
layout(std430, binding = 3) writeonly buffer Decoding { vec4 decoding[]; };

float done() { return turns_made() == asked_turns ? 1.0 : 2.0; }

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= normals.length()) return;
    vec3 view = views[i].xyz;
    CODE code = ENCODE(direction_or_forward(normals[i].xyz), view);
    // What is not used would not be computed.
    float is_done = done();
    encoding[i] = vec4(is_done, code.x + code.y, 0.0, 0.0);
    vec3 n = DECODE(code, view);
    decoding[i] = vec4(done(), n);
}
