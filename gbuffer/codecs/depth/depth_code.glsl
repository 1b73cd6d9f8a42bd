// The depth encoding at hand: DEPTH_ENCODE and DEPTH_DECODE are its functions, DEPTH_SIGNED is 1 where it keeps a sign, and
// DEPTH_OWN_UNITS is 1 where open floats hold the depth in the scene's own units, which is a far plane at 1.
#include "vec.glsl"
#include DEPTH_ENCODING

// The number of a view depth between the planes, range.x and range.y, and back. `is_open` says whether numbers beyond 1
// keep their value where it will lie.
float number_of_depth(float depth, vec2 range, bool is_open) {
    float far = is_open && DEPTH_OWN_UNITS != 0 ? 1.0 : range.y;
    return DEPTH_ENCODE(depth_or_far(depth, range.y), range.x, far);
}

float depth_of_number(float number, vec2 range, bool is_open) {
    return DEPTH_DECODE(number, range.x, is_open && DEPTH_OWN_UNITS != 0 ? 1.0 : range.y);
}
