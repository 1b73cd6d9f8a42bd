// The operation that does nothing but make 16 bits of each number and 32 of them again.
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require

MADE kernel_operation(GIVEN given, BESIDE beside) {
    HALF_GIVEN halves = HALF_GIVEN(given);
    MADE made;
    for (int i = 0; i < made.length(); ++i) made[i] = float(halves[i % given.length()]);
    return made;
}
