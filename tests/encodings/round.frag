#version 430
// The shader's own rounding, on any number; and the way back from numbers that are laid across channels.
#include "storage.glsl"

uniform sampler2D source;
out vec4 texel;

void main() {
    texel = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
#if READS
    texel = from_texel(texel);
#elif STORAGE_PART
    texel = to_texel(texel);
#else
    texel = round_texel(texel);
#endif
}
