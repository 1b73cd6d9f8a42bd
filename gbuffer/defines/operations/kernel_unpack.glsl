// A texel to a code, or to a depth and its sign if it carries one: the numbers from FIRST_NUMBER on. The near and the far
// plane are constants, as in kernel_pack.glsl.
#define DEPTH_RANGE vec2(KERNEL_NEAR, KERNEL_FAR)
#include "words.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) {
    vec4 texels[TARGETS];
    for (int i = 0; i < given.length(); ++i) texels[0][i] = given[i];
    float numbers[NUMBERS];
    // A number that nobody unpacks is what was given: a constant would be an instruction.
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = given[0];
    from_texels(texels, numbers);
    if (DEPTH_SIGNED != 0) {
        numbers[DEPTH + 1] = sign_bit(numbers[DEPTH]) ? -1.0 : 1.0;
        numbers[DEPTH] = abs(numbers[DEPTH]);
    }
    MADE made;
    for (int i = 0; i < made.length(); ++i) made[i] = numbers[FIRST_NUMBER + i];
    return made;
}
