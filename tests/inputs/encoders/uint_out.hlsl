void PackNormal(float3 n, out uint p) { float3 c = n * 0.5 + 0.5; p = uint(c.x * 1023.0 + 0.5) | (uint(c.y * 1023.0 + 0.5) << 10) | (uint(c.z * 1023.0 + 0.5) << 20); }
void UnpackNormal(uint p, out float3 n) { n = normalize(float3(p & 1023, (p >> 10) & 1023, (p >> 20) & 1023) / 1023.0 * 2.0 - 1.0); }
