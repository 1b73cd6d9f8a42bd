#version 430
// Whether a loop of an encoder or of a decoder goes on for more turns than it may: 1 where it does.
#include "turns.glsl"
#include "code.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 1) readonly buffer Views { vec4 views[]; };
layout(std430, binding = 2) writeonly buffer Encoding { vec4 encoding[]; };
layout(std430, binding = 3) writeonly buffer Decoding { vec4 decoding[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= normals.length()) return;
    vec3 view = views[i].xyz;
    count_anew();
    CODE code = ENCODE(direction_or_forward(normals[i].xyz), view);
    encoding[i] = vec4(endless);
    count_anew();
    vec3 n = DECODE(code, view);
    // What is not used would not be computed.
    decoding[i] = vec4(vec3(endless), n.x + n.y + n.z);
}
