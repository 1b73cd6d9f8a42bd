// Noise before rounding, beside dither.py: where DITHERED is 1, the code of a pixel with its noise.
#if DITHERED
uniform sampler2D dither;  // what is added to the numbers of a code, by pixel; it repeats

vec4 dithered(vec4 code) { return code + texelFetch(dither, ivec2(gl_FragCoord.xy) % textureSize(dither, 0), 0); }
#else
vec4 dithered(vec4 code) { return code; }
#endif
