// A normal and its view-space position to a code.
#include "code.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) { return ENCODE(given, beside); }
