// Normals encoded into the codec's render target, or by `pack` into a target of integers.
#ifdef PACKED
out uvec4 texel;
#else
out vec4 texel;
#endif

void main() {
#ifdef PACKED
    texel = PACK(encoded());
#else
    texel = TO_TARGET(encoded());
#endif
}
