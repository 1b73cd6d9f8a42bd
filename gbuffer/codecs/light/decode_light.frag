#version 430
// The light of a light buffer's texels, and their numbers.
#include "light_code.glsl"

uniform sampler2D texels;
layout(location = 0) out vec4 decoded;
layout(location = 1) out vec4 numbers;

void main() {
    vec4 texel = texelFetch(texels, ivec2(gl_FragCoord.xy), 0);
    numbers = light_numbers(texel);
    decoded = LIGHT_DECODE(texel);
}
