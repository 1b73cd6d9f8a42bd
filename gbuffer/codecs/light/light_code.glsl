// The light encoding at hand: LIGHT_ENCODE and LIGHT_DECODE are its functions. Where LIGHT_READS is 1 light is added to
// what was read, and not by blending. LIGHT_CHANNELS is how many the storage has.
#include "vec.glsl"
#include LIGHT_ENCODING

#if LIGHT_CHANNELS < 4
// A texel without a fourth channel is read as 1 there.
vec4 three_decoded(vec4 e) { return vec4(LIGHT_DECODE(e).xyz, 0.0); }
#undef LIGHT_DECODE
#define LIGHT_DECODE three_decoded
#endif
