// The tangent frame encoding at hand: FRAME_ENCODE and FRAME_DECODE are its functions, and FRAME_SETTLE where FRAME_SETTLES
// is 1. FRAME_LEAST is the least number above 0 that the storage holds where the hand lies.
#include "rotation.glsl"
#include FRAME_ENCODING
