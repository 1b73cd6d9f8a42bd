#version 430
// Encodes a texture of depths into the storage under test: HOME 0 packs into the 8-bit channels of the target from the bit
// FIRST on, 1 writes a channel of its own, 2 the depth buffer, 3 what BYTES_ENCODE makes of it. ROUNDING is a way to round of storage.glsl's.
#include "depth_code.glsl"
#include "storage.glsl"
#include "dither.glsl"

uniform sampler2D points;  // place on the screen, depth
uniform vec2 range;        // near, far
#if HOME != 2
layout(location = 0) out vec4 texel;
#endif

void main() {
    float depth = texelFetch(points, ivec2(gl_FragCoord.xy), 0).z;
    float number = number_of_depth(depth, range, OPEN != 0);
#if DITHERED
    number = with_sign_of(max(dithered(vec4(abs(number))).x, 0.0), number);  // noise leaves the sign as it is
#endif
#if HOME == 0
    float magnitude = clamp(DEPTH_SIGNED != 0 ? abs(number) : number, 0.0, 1.0);
    float whole = round_whole(magnitude, DEPTH_SIGNED != 0 ? floor(SCALE * 0.5) : SCALE, ROUNDING);
    uint integer = signed_code(whole, number, SCALE, DEPTH_SIGNED != 0);
    for (int c = 0; c < 4; ++c) texel[c] = float(part_in(integer, FIRST, BITS, c, 8)) / 255.0;
#elif HOME == 3
    texel = BYTES_ENCODE(number);
#elif HOME == 1
    texel = vec4(ROUNDS != 0 ? round_number(number, KIND, SCALE, 0, ROUNDING) : number);
#else
    gl_FragDepth = ROUNDS != 0 ? round_number(number, KIND, SCALE, 0, 0) : number;
#endif
}
