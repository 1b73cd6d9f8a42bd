// The empty pass of a timing: it reads what the other pass reads, and writes to the same target.
#if defined READS_CODES && defined PACKED
uniform usampler2D codes;
#elif defined READS_CODES
uniform sampler2D codes;
#endif
#ifdef WRITES_INTEGERS
out uvec4 made;
#else
out vec4 made;
#endif

void main() {
    vec4 given = texelFetch(normals, place(), 0);
#ifdef READS_CODES
    given = vec4(texelFetch(codes, place(), 0));
#endif
#ifdef WRITES_INTEGERS
    made = floatBitsToUint(given);
#else
    made = given;
#endif
}
