#version 430
// The injected light, from slices side by side into a slice of the volumes: the travelling light and the sum begin so.
#include "lpv_packed.glsl"

uniform sampler2D lpv_injected_red, lpv_injected_green, lpv_injected_blue;
uniform int slice;
layout(location = 0) out vec4 wave[3];
layout(location = 3) out vec4 light[3];

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) + CELLS * ivec2(slice % CELLS, slice / CELLS);
    wave[0] = light[0] = packed_wave(texelFetch(lpv_injected_red, at, 0));
    wave[1] = light[1] = packed_wave(texelFetch(lpv_injected_green, at, 0));
    wave[2] = light[2] = packed_wave(texelFetch(lpv_injected_blue, at, 0));
}
