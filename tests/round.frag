#version 430
// The shader's own rounding, on any number.
#include "../encodings/storage.glsl"

uniform sampler2D source;
out vec4 texel;

void main() {
    texel = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    for (int i = 0; i < 4; ++i) texel[i] = round_number(texel[i], i);
}
