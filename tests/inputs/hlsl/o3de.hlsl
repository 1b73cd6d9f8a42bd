// O3DE's deferred prototype: White's signed octahedral map in [0, 1], with the sign of z as a third number.
float3 EncodeNormalSignedOctahedron(float3 normal) {
    float3 p = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    return float3(0.5 + 0.5 * (p.x + p.y), 0.5 + 0.5 * (p.x - p.y), saturate(normal.z * 3.402823466e+38));
}

float3 DecodeNormalSignedOctahedron(float3 code) {
    float2 e = code.xy * 2.0 - 1.0;
    float3 n;
    n.x = (e.x + e.y) * 0.5;
    n.y = (e.x - e.y) * 0.5;
    n.z = (code.z > 0.5 ? 1.0 : -1.0) * (1.0 - abs(n.x) - abs(n.y));
    return normalize(n);
}
