// A texel to the numbers of a code, as its storage has them.
#include "storage.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) {
    vec4 texel = vec4(0.0);
    for (int i = 0; i < given.length(); ++i) texel[i] = given[i];
#if STORAGE_WORD
    return MADE(from_word(floatBitsToUint(texel.x)));
#else
    return MADE(from_texel(texel));
#endif
}
