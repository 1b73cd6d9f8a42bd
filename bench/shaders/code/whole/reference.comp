#version 430
// What the renderer makes of a surface's numbers and of texels: `gbuffer.glsl` without a camera. A row is a normal, the
// NUMBERS numbers, TARGETS texels, the place in view space, and the near and the far plane; what is made of it is TARGETS
// texels, a normal, and numbers.
vec2 depth_range;
vec3 place;
#define DEPTH_RANGE depth_range
#include "code.glsl"
#include "words.glsl"
#include CURVES

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { uint given[]; };
layout(std430, binding = 1) writeonly buffer Made { uint made[]; };

uint texel_word(vec4 texels[TARGETS], int target, int channel) {
#if HAS_WORDS
    if (target_integer[target] != 0) return target_words[target][channel];
#endif
    return floatBitsToUint(texels[target][channel]);
}

void write_texels(uint from, uint to) {
    const float scales[] = NORMAL_SCALE;
    vec3 n = vec3(uintBitsToFloat(given[from]), uintBitsToFloat(given[from + 1u]), uintBitsToFloat(given[from + 2u]));
    float numbers[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = uintBitsToFloat(given[from + 3u + uint(i)]);
    vec4 code = widen(encoded(direction_or_forward(n), place, scales, NORMAL_BIASED != 0));
    for (int i = 0; i < DEPTH; ++i) numbers[i] = code[i];
#if SIGN_IN_DEPTH
    numbers[DEPTH] *= code[SIGN_NUMBER];
#endif
    vec3 emission = vec3(numbers[EMISSION], numbers[EMISSION + 1], numbers[EMISSION + 2]);
    TO_CURVES
#if EMISSION_CODED
    vec4 light = EMISSION_ENCODE(light_or_none(vec4(emission, 0.0)));
    for (int i = 0; i < 4; ++i) numbers[EMISSION + i] = light[i];
#endif
    vec4 texels[TARGETS] = to_texels(numbers);
    for (int t = 0; t < TARGETS; ++t)
        for (int c = 0; c < 4; ++c) made[to + uint(t * 4 + c)] = texel_word(texels, t, c);
}

void read_texels(uint from, uint to) {
    vec4 texels[TARGETS];
    for (int t = 0; t < TARGETS; ++t)
        for (int c = 0; c < 4; ++c) {
            uint word = given[from + uint(t * 4 + c)];
            texels[t][c] = uintBitsToFloat(word);
#if HAS_WORDS
            target_words[t][c] = word;
#endif
        }
    float numbers[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = 0.0;
    from_texels(texels, numbers);
    FROM_CURVES
#if EMISSION_CODED
    vec4 light = EMISSION_DECODE(vec4(numbers[EMISSION], numbers[EMISSION + 1], numbers[EMISSION + 2], numbers[EMISSION + 3]));
    for (int i = 0; i < 3; ++i) numbers[EMISSION + i] = light[i];
#endif
    vec4 code = vec4(numbers[0], numbers[1], numbers[2], 0.0);
#if SIGN_IN_DEPTH
    code[SIGN_NUMBER] = sign_bit(numbers[DEPTH]) ? -1.0 : 1.0;
#endif
    numbers[DEPTH] = abs(numbers[DEPTH]);
    vec3 n = DECODE(CODE(code), place);
    for (int i = 0; i < 3; ++i) made[to + uint(i)] = floatBitsToUint(n[i]);
    for (int i = 0; i < NUMBERS; ++i) made[to + 3u + uint(i)] = floatBitsToUint(numbers[i]);
}

void main() {
    uint made_row = uint(3 + NUMBERS + 4 * TARGETS), row = made_row + 5u, i = gl_GlobalInvocationID.x;
    if (i >= uint(given.length()) / row) return;
    uint from = i * row, to = i * made_row, at = from + made_row;
    place = vec3(uintBitsToFloat(given[at]), uintBitsToFloat(given[at + 1u]), uintBitsToFloat(given[at + 2u]));
    depth_range = vec2(uintBitsToFloat(given[at + 3u]), uintBitsToFloat(given[at + 4u]));
    write_texels(from, to);
    read_texels(from + uint(3 + NUMBERS), to + uint(4 * TARGETS));
}
