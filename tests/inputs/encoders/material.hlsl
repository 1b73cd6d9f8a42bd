struct Surface { float3 albedo; float3 normalWS; float roughness; uint flags; };
struct Buffers { float4 o0; float4 o1; };
float2 Oct(float3 n) { n /= abs(n.x) + abs(n.y) + abs(n.z); float2 w = (1.0 - abs(n.yx)) * float2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0); return n.z >= 0.0 ? n.xy : w; }
float3 UnOct(float2 e) { float3 n = float3(e, 1.0 - abs(e.x) - abs(e.y)); float t = max(-n.z, 0.0); n.x += n.x >= 0.0 ? -t : t; n.y += n.y >= 0.0 ? -t : t; return normalize(n); }
void PackSurface(Surface s, out float4 o0, out float4 o1) { o0 = float4(s.albedo, s.roughness); o1 = float4(Oct(s.normalWS) * 0.5 + 0.5, s.roughness, 0); }
Surface UnpackSurface(float4 o0, float4 o1) { Surface s; s.albedo = o0.xyz; s.roughness = o0.w; s.flags = 0; s.normalWS = UnOct(o1.xy * 2.0 - 1.0); return s; }
