// What comes back at each pixel, as the bits of floats; then the stored code, 10 bits for each of its first three numbers.
out uvec4 decoded;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface seen = surface_at(pixel);
#ifdef EXACT
    decoded = uvec4(floatBitsToUint(seen.n), 0u);
#else
    CODE code = code_at(pixel);
    uvec3 shown = uvec3(clamp(PADDED(code * 0.5 + 0.5).xyz, 0.0, 1.0) * 1023.0 + 0.5);
    decoded = uvec4(floatBitsToUint(DECODE(code, seen.view)), shown.x | (shown.y << 10) | (shown.z << 20));
#endif
}
