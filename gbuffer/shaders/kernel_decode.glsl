// A code and its view-space position to a normal.
#include "code.glsl"

MADE operation(GIVEN given, BESIDE beside) { return DECODE(given, beside); }
