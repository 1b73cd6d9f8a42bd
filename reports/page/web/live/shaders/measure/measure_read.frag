// What a shader reads from a render target, as integers: the bits of floats, or how many steps of SCALES a number has.
uniform sampler2D codes;
out uvec4 bits;

void main() {
    vec4 read = texelFetch(codes, place(), 0);
#ifdef FLOATS
    bits = floatBitsToUint(read);
#else
    bits = uvec4(ivec4(roundEven(read * SCALES)));
#endif
}
