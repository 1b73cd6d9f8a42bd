#version 430
// The light of a light buffer's texels, and the texels themselves.
#include "light_code.glsl"

uniform sampler2D texels;
layout(location = 0) out vec4 decoded;
layout(location = 1) out vec4 texel;

void main() {
    texel = texelFetch(texels, ivec2(gl_FragCoord.xy), 0);
    decoded = LIGHT_DECODE(texel);
}
