// Normals encoded into the codec's render target, or by `pack` into a target of integers.
#if PACKS
layout(location = 0) out uvec4 texel;
#else
layout(location = 0) out vec4 texel;
#endif

void main() {
#if PACKS
    texel = uvec4(0u);
    texel.PACKED = PACK(encoded());
#else
    texel = TO_TARGET(encoded());
#endif
}
