// A code and its view-space position to a normal.
#include "code.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) { return DECODE(given, beside); }
