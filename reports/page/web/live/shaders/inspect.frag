// One pixel in numbers: the normal, what comes back, the texel and the position, as the bits of floats.
uniform ivec2 pixel;

out uvec4 found;

void main() {
    Surface seen = surface_at(pixel);
#ifdef EXACT
    vec3 n = seen.n;
    uvec4 words = uvec4(0u);
#else
    CODE code = code_at(pixel);
    vec3 n = DECODE(code, seen.view);
    uvec4 words = levels > 0.0 ? floatBitsToUint(PADDED(code)) : PACK(code);
#endif
    int at = int(gl_FragCoord.x);
    found = at == 0 ? uvec4(floatBitsToUint(seen.n), seen.covered ? 1u : 0u)
        : at == 1 ? uvec4(floatBitsToUint(n), 0u)
        : at == 2 ? words : uvec4(floatBitsToUint(seen.view), 0u);
}
