// Donut, NVIDIA's samples: x, y and z as they are, for signed formats.
float3 StoreNormal_encode(float3 n) { return n; }
float3 StoreNormal_decode(float3 n) { return normalize(n); }
