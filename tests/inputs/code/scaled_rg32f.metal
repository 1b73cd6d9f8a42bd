// By hand, for tests of the runners: a code with a view, a table, a sign and two words. Every step is exact.
#include <metal_stdlib>
using namespace metal;

inline float scaled_rg32f_step(float z, texture2d<float> scaled_steps) { return scaled_steps.read(uint2(z < 0.0 ? 1 : 0, 0)).y; }

inline float3 scaled_rg32f_encode(float3 n, float3 view, texture2d<float> scaled_steps) {
    return float3(n.xy * scaled_rg32f_step(n.z, scaled_steps) + view.xy, n.z < 0.0 ? -1.0 : 1.0);
}
inline uint2 scaled_rg32f_pack(float3 code) { return as_type<uint2>(code.xy); }
inline float3 scaled_rg32f_unpack(uint2 words, float sign) { return float3(as_type<float2>(words), sign); }
inline float3 scaled_rg32f_decode(float3 e, float3 view, texture2d<float> scaled_steps) { return float3((e.xy - view.xy) / scaled_rg32f_step(e.z, scaled_steps), e.z); }
inline float4 scaled_rg32f_to_target(float3 code) { return float4(code.xy, 0.0, 1.0); }
inline float3 scaled_rg32f_from_target(float4 texel, float sign) { return float3(texel.xy, sign); }
