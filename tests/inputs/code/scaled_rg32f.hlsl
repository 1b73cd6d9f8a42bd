// By hand, for tests of the runners: a code with a view, a table, a sign and two words. Every step is exact.
Texture2D<float4> scaled_steps;

float scaled_rg32f_step(float z) { return scaled_steps.Load(int3(z < 0.0 ? 1 : 0, 0, 0)).y; }

float3 scaled_rg32f_encode(float3 n, float3 view) {
    return float3(n.xy * scaled_rg32f_step(n.z) + view.xy, n.z < 0.0 ? -1.0 : 1.0);
}
uint2 scaled_rg32f_pack(float3 code) { return asuint(code.xy); }
float3 scaled_rg32f_unpack(uint2 words, float sign) { return float3(asfloat(words), sign); }
float3 scaled_rg32f_decode(float3 e, float3 view) { return float3((e.xy - view.xy) / scaled_rg32f_step(e.z), e.z); }
float4 scaled_rg32f_to_target(float3 code) { return float4(code.xy, 0.0, 1.0); }
float3 scaled_rg32f_from_target(float4 texel, float sign) { return float3(texel.xy, sign); }
