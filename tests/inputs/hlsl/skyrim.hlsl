// Skyrim Community Shaders: the octahedral map of the opposite direction, in [0, 1].
float2 EncodeNormal(float3 n) {
    n = -n;
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * (step(0.0, n.xy) * 2.0 - 1.0);
    return n.xy * 0.5 + 0.5;
}

float3 DecodeNormal(float2 f) {
    f = f * 2.0 - 1.0;
    float3 n = float3(f, 1.0 - abs(f.x) - abs(f.y));
    float t = max(-n.z, 0.0);
    n.xy += lerp((float2)t, (float2)-t, step(0.0, n.xy));
    return -normalize(n);
}
