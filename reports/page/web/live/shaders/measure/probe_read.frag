// The bits of what a shader reads from a texture: texel by texel, or between the first two.
precision highp float;
precision highp sampler2D;
uniform sampler2D codes;
out uvec4 bits;

void main() {
#ifdef FILTERS
    // from the middle of the first texel of two to the middle of the second
    vec2 at = vec2(0.25 + 0.5 * floor(gl_FragCoord.x) / float(POSITIONS), 0.5);
    bits = floatBitsToUint(texture(codes, at));
#else
    bits = floatBitsToUint(texelFetch(codes, ivec2(gl_FragCoord.xy), 0));
#endif
}
