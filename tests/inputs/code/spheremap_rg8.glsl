// Spheremap in RG8, by hand: what tests of the runners run.
vec2 spheremap_rg8_encode(vec3 n) {
    float f = sqrt(8.0 * n.z + 8.0);
    return n.z > -1.0 ? n.xy * (2.0 / f) : vec2(1.0, 0.0);
}
uint spheremap_rg8_pack(vec2 code) {
    uvec2 bytes = uvec2(roundEven(clamp(code * 0.5 + 0.5, 0.0, 1.0) * float(255)));
    return bytes.x | bytes.y << 8;
}
vec2 spheremap_rg8_unpack(uint words) { return vec2(words & 255u, words >> 8 & 255u) * (1.0 / float(255)) * 2.0 - 1.0; }
vec3 spheremap_rg8_decode(vec2 e) {
    vec2 fenc = e * 2.0;
    float f = min(dot(fenc, fenc), 4.0);
    return vec3(fenc * sqrt(1.0 - f / 4.0), 1.0 - f / 2.0);
}
vec4 spheremap_rg8_to_target(vec2 code) { return vec4(code * 0.5 + 0.5, 0.0, 1.0); }
vec2 spheremap_rg8_from_target(vec4 texel) { return texel.xy * 2.0 - 1.0; }
