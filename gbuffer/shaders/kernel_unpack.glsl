// A texel to a code, or to a depth beside the near and the far plane: the numbers from FIRST_NUMBER on.
#define DEPTH_RANGE depth_range
vec2 depth_range;
#include "words.glsl"

MADE operation(GIVEN given, BESIDE beside) {
    vec4 texels[TARGETS];
    for (int i = 0; i < given.length(); ++i) texels[0][i] = given[i];
    float numbers[NUMBERS];
    // A number that nobody unpacks is what was given: a constant would be an instruction.
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = given[0];
    depth_range = beside.yz;
    from_texels(texels, numbers);
    MADE made;
    for (int i = 0; i < made.length(); ++i) made[i] = numbers[FIRST_NUMBER + i];
    return made;
}
