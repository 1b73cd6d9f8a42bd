// What comes back of a texel: of the codec's own format, or of integers.
#ifdef PACKED
uniform highp usampler2D code_texels;
#else
uniform highp sampler2D code_texels;
#endif
uniform highp sampler2D sign_texels;
uniform float levels;

CODE code_at(ivec2 pixel) {
#ifdef HAS_SIGN
    float sign = texelFetch(sign_texels, pixel, 0).x < 0.5 ? -1.0 : 1.0;
#else
    float sign = 1.0;
#endif
#ifdef PACKED
    uvec4 words = texelFetch(code_texels, pixel, 0);
    if (levels > 0.0) {
        return CODE_OF(uintBitsToFloat(words));
    }
    return UNPACK(words, sign);
#else
    return FROM_TARGET(texelFetch(code_texels, pixel, 0), sign);
#endif
}
