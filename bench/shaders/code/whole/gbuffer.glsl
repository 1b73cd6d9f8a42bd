#version 430
// What the code of a whole layout is made from: the encoding of the normal, that of the depth, and the curves and codes of
// the rest. The two functions, which gbuffer.glsl.j2 makes, follow.
#include "vec.glsl"
#include "storage.glsl"
#include ENCODING
#include "turned.glsl"
#include DEPTH_ENCODING
#include CURVES
