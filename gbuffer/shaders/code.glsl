// The code of the encoding at hand: CODE is vec2 or vec3, ENCODE and DECODE are its functions, COMPONENTS of its numbers
// go to the normal's target and SIGN_BITS (0 or 1) to the depth's sign.
#include "../../encodings/vec.glsl"
#include ENCODING

vec4 widen(vec2 code) { return vec4(code, 0.0, 0.0); }
vec4 widen(vec3 code) { return vec4(code, 0.0); }
