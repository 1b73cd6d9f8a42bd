// The light encoding at hand: LIGHT_ENCODE and LIGHT_DECODE are its functions. Where LIGHT_READS is 1 light is added to
// what was read, and not by blending. LIGHT_CHANNELS is how many the storage has.
// Where LIGHT_PACKED is 1 numbers lie across the channels of the target, as storage.glsl lays them.
#include "vec.glsl"
#include "storage.glsl"
#include LIGHT_ENCODING

// What a texel of the target holds, as the encoding made it.
#if LIGHT_PACKED
vec4 light_numbers(vec4 texel) { return from_texel(texel); }
vec4 packed_encoded(vec4 light) { return to_texel(LIGHT_ENCODE(light)); }
vec4 packed_decoded(vec4 texel) { return LIGHT_DECODE(from_texel(texel)); }
#undef LIGHT_ENCODE
#undef LIGHT_DECODE
#define LIGHT_ENCODE packed_encoded
#define LIGHT_DECODE packed_decoded
#else
vec4 light_numbers(vec4 texel) { return texel; }
#endif

#if LIGHT_CHANNELS < 4
// A texel without a fourth channel is read as 1 there.
vec4 three_decoded(vec4 e) { return vec4(LIGHT_DECODE(e).xyz, 0.0); }
#undef LIGHT_DECODE
#define LIGHT_DECODE three_decoded
#endif
