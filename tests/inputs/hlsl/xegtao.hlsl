// XeGTAO: x, y and z in [0, 1], for 11:11:10 bits.
float3 XeGTAO_EncodeViewNormal(float3 n) { return saturate(n * 0.5 + 0.5); }
float3 XeGTAO_DecodeViewNormal(float3 c) { return normalize(c * 2.0.xxx - 1.0.xxx); }
