#version 430
// What a codec's code is made from: the encoding's own functions, and bits of floats. The storage's functions, which
// storage.glsl.j2 makes, follow.
#include "vec.glsl"
#include ENCODING
#include "turned.glsl"
#include "storage.glsl"
