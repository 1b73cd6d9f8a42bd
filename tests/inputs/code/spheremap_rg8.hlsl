// Spheremap in RG8, by hand: what tests of the runners run.
float2 spheremap_rg8_encode(float3 n) {
    float f = sqrt(8.0 * n.z + 8.0);
    return n.z > -1.0 ? n.xy * (2.0 / f) : float2(1.0, 0.0);
}
uint spheremap_rg8_pack(float2 code) {
    uint2 bytes = uint2(round(clamp(code * 0.5 + 0.5, 0.0, 1.0) * 255.0));
    return bytes.x | bytes.y << 8;
}
float2 spheremap_rg8_unpack(uint words) { return float2(float(words & 255u), float(words >> 8 & 255u)) * (1.0 / 255.0) * 2.0 - 1.0; }
float3 spheremap_rg8_decode(float2 e) {
    float2 fenc = e * 2.0;
    float f = min(dot(fenc, fenc), 4.0);
    return float3(fenc * sqrt(1.0 - f / 4.0), 1.0 - f / 2.0);
}
float4 spheremap_rg8_to_target(float2 code) { return float4(code * 0.5 + 0.5, 0.0, 1.0); }
float2 spheremap_rg8_from_target(float4 texel) { return texel.xy * 2.0 - 1.0; }
