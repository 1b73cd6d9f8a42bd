// A code and its view-space position to a normal, in 16-bit types.
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#include "half.glsl"
#include "vec.glsl"
#include ENCODING
#include "turned.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) { return MADE(DECODE(HALF_GIVEN(given), HALF_BESIDE(beside))); }
