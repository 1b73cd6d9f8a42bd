// A code, or a depth, to a texel as a target is given it. A depth that carries a sign is given that first. The near and the
// far plane are constants: an engine has what is computed of them ready in a uniform, here the compiler folds it.
#define DEPTH_RANGE vec2(KERNEL_NEAR, KERNEL_FAR)
#include "words.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) {
    float numbers[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = 0.0;
    for (int i = 0; i < given.length(); ++i) numbers[i] = given[i];
    numbers[DEPTH] = DEPTH_SIGNED != 0 ? given.x * beside.x : beside.x;
    return MADE(to_texels(numbers)[0]);
}
