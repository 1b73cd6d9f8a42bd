// The motion encoding at hand: MOTION_ENCODE and MOTION_DECODE are its functions. MOTION_NEEDS_RANGE is 0 where the storage
// holds the motion in screens, which is a range of 1.
#include "vec.glsl"
#include MOTION_ENCODING

vec2 code_of_motion(vec2 motion, float range) { return MOTION_ENCODE(motion, MOTION_NEEDS_RANGE != 0 ? range : 1.0); }
vec2 motion_of_code(vec2 code, float range) { return MOTION_DECODE(code, MOTION_NEEDS_RANGE != 0 ? range : 1.0); }
