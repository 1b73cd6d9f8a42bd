#version 430
// What a codec's code is made from: the encoding's own functions, and bits of floats. The storage's functions, which
// storage.glsl.j2 makes, follow.
#include "vec.glsl"
#ifdef FRAMES
#include "rotation.glsl"
#endif
#include ENCODING
#include "turned.glsl"

#ifdef COLOUR_ENCODE
// Of light without a fourth number.
vec4 colour_encode(vec3 light) { return COLOUR_ENCODE(vec4(light, 0.0)); }
vec3 colour_decode(vec4 e) { return COLOUR_DECODE(e).xyz; }
#endif

#ifdef DEPTH_ENCODE
// Infinite depth, NaN and what is beyond the far plane are stored as the far plane is.
float depth_encode(float depth, float near, float far) {
#if DEPTH_SIGNED
    return DEPTH_ENCODE(depth_or_far(depth, far), near, far);
#else
    return DEPTH_ENCODE(depth <= far ? depth : far, near, far);
#endif
}
#endif
#include "storage.glsl"
