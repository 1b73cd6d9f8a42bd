float2 normalbench_encode(float3 n VIEW) {
    uint k = asuint(PACK(n GIVEN_E));
    return float2(float(k & 0xFFFFu), float(k >> 16)) * (2.0 / LARGEST) - 1.0;
}
float3 normalbench_decode(float2 e VIEW) {
    uint2 k = uint2(floor((e * 0.5 + 0.5) * LARGEST + 0.5));
    return UNPACK(asVALUE(k.x | (k.y << 16)) GIVEN_D);
}
