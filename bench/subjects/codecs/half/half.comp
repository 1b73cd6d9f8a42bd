#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
// An encoder or a decoder in half arithmetic. ENCODES is 1 for the encoder; BIASED is 1 where a number c is stored as
// c/2 + 1/2, which is a step of the shader as well. `given` and `made` are of 32 bits: what a format stores.
#include "half.glsl"
#include "vec.glsl"
#include ENCODING
#include "turned.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 1) readonly buffer Views { vec4 views[]; };
layout(std430, binding = 2) buffer Made { vec4 made[]; };

f16vec4 widened(f16vec2 code) { return f16vec4(code, 0.0hf, 0.0hf); }
f16vec4 widened(f16vec3 code) { return f16vec4(code, 0.0hf); }

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= given.length()) return;
    f16vec3 view = f16vec3(views[i].xyz);
    f16vec4 numbers = f16vec4(given[i]);
#if ENCODES
    numbers = widened(ENCODE(direction_or_forward(numbers.xyz), view));
    for (int c = 0; c < COMPONENTS; ++c) numbers[c] = BIASED != 0 ? numbers[c] * 0.5hf + 0.5hf : numbers[c];
    made[i] = vec4(numbers);
#else
    for (int c = 0; c < COMPONENTS; ++c) numbers[c] = BIASED != 0 ? numbers[c] * 2.0hf - 1.0hf : numbers[c];
    made[i] = vec4(vec3(DECODE(HALF_CODE(numbers), view)), 0.0);
#endif
}
