// NRD, mode 0: the direction over its largest component, in [0, 1].
#include "nrd.hlsli"

float3 NRD_EncodeNormal(float3 n) { return OverLargest(n) * 0.5 + 0.5; }
float3 NRD_DecodeNormal(float3 c) { return normalize(c * 2.0 - 1.0); }
