// The numbers of a code to a texel, as its storage has them.
#include "storage.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) {
    vec4 code = vec4(0.0);
    for (int i = 0; i < given.length(); ++i) code[i] = given[i];
#if STORAGE_WORD
    return MADE(uintBitsToFloat(to_word(code)));
#else
    return MADE(to_texel(code));
#endif
}
