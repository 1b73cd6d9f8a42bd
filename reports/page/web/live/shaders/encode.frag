// Each pixel's normal as its code: into the codec's own format, or as integers where that cannot be rendered to.
uniform float levels;  // of each number, in place of the storage's; 0 for the storage's

#ifdef PACKED
out uvec4 texel;
#else
out vec4 texel;
#endif

void main() {
    Surface seen = surface_at(ivec2(gl_FragCoord.xy));
    CODE code = ENCODE(seen.n, seen.view);
#ifdef PACKED
    texel = levels > 0.0 ? floatBitsToUint(PADDED(fewer_bits(code, levels))) : PACK(code);
#elif defined SIGNS
    texel = vec4(code[SIZE - 1] < 0.0 ? 0.0 : 1.0);
#else
    texel = TO_TARGET(code);
#endif
}
