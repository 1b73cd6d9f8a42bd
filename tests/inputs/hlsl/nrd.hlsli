#ifndef NRD_HLSLI
#define NRD_HLSLI
float3 OverLargest(float3 n) { return n / max(abs(n.x), max(abs(n.y), abs(n.z))); }
#endif
