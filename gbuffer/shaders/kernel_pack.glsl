// A code, or a depth beside the near and the far plane, to a texel as a target is given it.
#define DEPTH_RANGE depth_range
vec2 depth_range;
#include "words.glsl"

MADE operation(GIVEN given, BESIDE beside) {
    float numbers[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = 0.0;
    for (int i = 0; i < given.length(); ++i) numbers[i] = given[i];
    numbers[DEPTH] = beside.x;
    depth_range = beside.yz;
    return MADE(to_texels(numbers)[0]);
}
