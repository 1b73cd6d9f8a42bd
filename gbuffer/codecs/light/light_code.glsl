// The light encoding at hand: LIGHT_ENCODE and LIGHT_DECODE are its functions. Where LIGHT_READS is 1 light is added to
// what was read, and not by blending.
#include "vec.glsl"
#include LIGHT_ENCODING
