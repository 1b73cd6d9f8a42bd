// The empty pass of a timing: it reads what the other pass reads, and writes to the same target.
#if READS_CODES
#if PACKS
uniform usampler2D codes;
#else
uniform sampler2D codes;
#endif
#endif
#if WRITES_INTEGERS
layout(location = 0) out uvec4 made;
#else
layout(location = 0) out vec4 made;
#endif

void main() {
    vec4 given = texelFetch(normals, place(), 0);
#if READS_CODES
    given = vec4(texelFetch(codes, place(), 0));
#endif
#if WRITES_INTEGERS
    made = floatBitsToUint(given);
#else
    made = given;
#endif
}
