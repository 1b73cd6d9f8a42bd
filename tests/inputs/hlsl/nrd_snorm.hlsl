// NRD, mode 1: the direction over its largest component, in [-1, 1].
#include "nrd.hlsli"

float3 NRD_EncodeNormal(float3 n) { return OverLargest(n); }
float3 NRD_DecodeNormal(float3 c) { return normalize(c); }
