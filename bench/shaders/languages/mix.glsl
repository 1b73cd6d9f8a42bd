// mix() for every type: GLSL 4.30 has none of whole numbers and truth values, which Slang writes for a ? b : c.
float MIX(float a, float b, float t) { return mix(a, b, t); }
vec2 MIX(vec2 a, vec2 b, float t) { return mix(a, b, t); }
vec3 MIX(vec3 a, vec3 b, float t) { return mix(a, b, t); }
vec4 MIX(vec4 a, vec4 b, float t) { return mix(a, b, t); }
vec2 MIX(vec2 a, vec2 b, vec2 t) { return mix(a, b, t); }
vec3 MIX(vec3 a, vec3 b, vec3 t) { return mix(a, b, t); }
vec4 MIX(vec4 a, vec4 b, vec4 t) { return mix(a, b, t); }
float MIX(float a, float b, bool t) { return t ? b : a; }
vec2 MIX(vec2 a, vec2 b, bvec2 t) { return mix(a, b, t); }
vec3 MIX(vec3 a, vec3 b, bvec3 t) { return mix(a, b, t); }
vec4 MIX(vec4 a, vec4 b, bvec4 t) { return mix(a, b, t); }
int MIX(int a, int b, bool t) { return t ? b : a; }
ivec2 MIX(ivec2 a, ivec2 b, bvec2 t) { return ivec2(t.x ? b.x : a.x, t.y ? b.y : a.y); }
ivec3 MIX(ivec3 a, ivec3 b, bvec3 t) { return ivec3(MIX(a.xy, b.xy, t.xy), t.z ? b.z : a.z); }
ivec4 MIX(ivec4 a, ivec4 b, bvec4 t) { return ivec4(MIX(a.xy, b.xy, t.xy), MIX(a.zw, b.zw, t.zw)); }
uint MIX(uint a, uint b, bool t) { return t ? b : a; }
uvec2 MIX(uvec2 a, uvec2 b, bvec2 t) { return uvec2(t.x ? b.x : a.x, t.y ? b.y : a.y); }
uvec3 MIX(uvec3 a, uvec3 b, bvec3 t) { return uvec3(MIX(a.xy, b.xy, t.xy), t.z ? b.z : a.z); }
uvec4 MIX(uvec4 a, uvec4 b, bvec4 t) { return uvec4(MIX(a.xy, b.xy, t.xy), MIX(a.zw, b.zw, t.zw)); }
bool MIX(bool a, bool b, bool t) { return t ? b : a; }
bvec2 MIX(bvec2 a, bvec2 b, bvec2 t) { return bvec2(t.x ? b.x : a.x, t.y ? b.y : a.y); }
bvec3 MIX(bvec3 a, bvec3 b, bvec3 t) { return bvec3(MIX(a.xy, b.xy, t.xy), t.z ? b.z : a.z); }
bvec4 MIX(bvec4 a, bvec4 b, bvec4 t) { return bvec4(MIX(a.xy, b.xy, t.xy), MIX(a.zw, b.zw, t.zw)); }
