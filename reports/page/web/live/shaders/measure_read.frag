// What a shader reads from a render target, as integers: those that stand for fixed-point numbers, or the bits of floats.
uniform sampler2D codes;
layout(location = 0) out uvec4 bits;

void main() {
    vec4 read = texelFetch(codes, place(), 0);
#if FLOATS
    bits = floatBitsToUint(read);
#else
    bits = uvec4(ivec4(roundEven(read * SCALES)));
#endif
}
