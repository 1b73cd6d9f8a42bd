float4 EncodeGBuffer(float3 worldNormal, float3 worldPos, float depth) { return float4(worldNormal.xy * 0.5 + 0.5, depth, worldNormal.z < 0 ? 0.0 : 1.0); }
void DecodeGBuffer(float4 gb, out float3 worldNormal, out float depth) { depth = gb.z; worldNormal.xy = gb.xy * 2.0 - 1.0; worldNormal.z = sqrt(saturate(1.0 - dot(worldNormal.xy, worldNormal.xy))) * (gb.w > 0.5 ? 1.0 : -1.0); }
