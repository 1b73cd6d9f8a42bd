void dirPack(in vec3 n, in float roughness, out vec4 o) { o = vec4(n * 0.5 + 0.5, roughness); }
vec3 dirUnpack(in vec4 o, out float roughness) { roughness = o.w; return normalize(o.xyz * 2.0 - 1.0); }
