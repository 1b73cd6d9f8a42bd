#version 430
// The shader's own rounding, on any number.
#include "../encodings/storage.glsl"

uniform sampler2D source;
out vec4 texel;

void main() {
    texel = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    texel = round_texel(texel);
}
