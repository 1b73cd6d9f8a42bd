// The code of texels that met: what a filter, a resolve or a blend left in a channel is read like any texel. A sign bit
// is the sign of the depths that met.
#include "code.glsl"

CODE met(vec4 texel, float signed_depth) {
    vec4 numbers = from_texel(texel);
#if SIGN_BITS
    numbers[COMPONENTS] = sign_bit(signed_depth) ? -1.0 : 1.0;
#endif
    return CODE(numbers);
}
