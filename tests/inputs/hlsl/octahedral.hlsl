// The octahedral map step by step as encodings/normals/octahedral.glsl has it, so that both cost the same.
float2 SignNotZero(float2 v) { return float2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0); }

float2 EncodeNormal(float3 n) {
    float2 p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)));
    return n.z < 0.0 ? (1.0 - abs(p.yx)) * SignNotZero(p) : p;
}

float3 DecodeNormal(float2 e) {
    float z = 1.0 - abs(e.x) - abs(e.y);
    float2 p = e - SignNotZero(e) * max(-z, 0.0);
    return normalize(float3(p, z));
}
