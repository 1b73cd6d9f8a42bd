// What WGSL defines and GLSL does not, for every type: quotients and remainders by 0, and of the least number by -1;
// remainders of negative numbers; floats that no integer is near.
int __quotient(int x, int y) { return y == 0 || (y == -1 && x == -(1 << 30) - (1 << 30)) ? x : x / y; }
int __remainder(int x, int y) { return y == 0 || y == -1 ? 0 : x - x / y * y; }
uint __quotient(uint x, uint y) { return y == 0u ? x : x / y; }
uint __remainder(uint x, uint y) { return y == 0u ? 0u : x % y; }
int __to_int(float x) {
    if (x >= exp2(15.0) * exp2(16.0)) return (1 << 30) - 1 + (1 << 30);
    return x >= -exp2(15.0) * exp2(16.0) ? int(x) : -(1 << 30) - (1 << 30);
}
uint __to_uint(float x) { return x >= exp2(16.0) * exp2(16.0) ? ~0u : x >= 0.0 ? uint(x) : 0u; }
ivec2 __quotient(ivec2 x, ivec2 y) { return ivec2(__quotient(x.x, y.x), __quotient(x.y, y.y)); }
ivec2 __remainder(ivec2 x, ivec2 y) { return ivec2(__remainder(x.x, y.x), __remainder(x.y, y.y)); }
ivec2 __to_int(vec2 x) { return ivec2(__to_int(x.x), __to_int(x.y)); }
uvec2 __quotient(uvec2 x, uvec2 y) { return uvec2(__quotient(x.x, y.x), __quotient(x.y, y.y)); }
uvec2 __remainder(uvec2 x, uvec2 y) { return uvec2(__remainder(x.x, y.x), __remainder(x.y, y.y)); }
uvec2 __to_uint(vec2 x) { return uvec2(__to_uint(x.x), __to_uint(x.y)); }
ivec3 __quotient(ivec3 x, ivec3 y) { return ivec3(__quotient(x.x, y.x), __quotient(x.y, y.y), __quotient(x.z, y.z)); }
ivec3 __remainder(ivec3 x, ivec3 y) { return ivec3(__remainder(x.x, y.x), __remainder(x.y, y.y), __remainder(x.z, y.z)); }
ivec3 __to_int(vec3 x) { return ivec3(__to_int(x.x), __to_int(x.y), __to_int(x.z)); }
uvec3 __quotient(uvec3 x, uvec3 y) { return uvec3(__quotient(x.x, y.x), __quotient(x.y, y.y), __quotient(x.z, y.z)); }
uvec3 __remainder(uvec3 x, uvec3 y) { return uvec3(__remainder(x.x, y.x), __remainder(x.y, y.y), __remainder(x.z, y.z)); }
uvec3 __to_uint(vec3 x) { return uvec3(__to_uint(x.x), __to_uint(x.y), __to_uint(x.z)); }
ivec4 __quotient(ivec4 x, ivec4 y) { return ivec4(__quotient(x.x, y.x), __quotient(x.y, y.y), __quotient(x.z, y.z), __quotient(x.w, y.w)); }
ivec4 __remainder(ivec4 x, ivec4 y) { return ivec4(__remainder(x.x, y.x), __remainder(x.y, y.y), __remainder(x.z, y.z), __remainder(x.w, y.w)); }
ivec4 __to_int(vec4 x) { return ivec4(__to_int(x.x), __to_int(x.y), __to_int(x.z), __to_int(x.w)); }
uvec4 __quotient(uvec4 x, uvec4 y) { return uvec4(__quotient(x.x, y.x), __quotient(x.y, y.y), __quotient(x.z, y.z), __quotient(x.w, y.w)); }
uvec4 __remainder(uvec4 x, uvec4 y) { return uvec4(__remainder(x.x, y.x), __remainder(x.y, y.y), __remainder(x.z, y.z), __remainder(x.w, y.w)); }
uvec4 __to_uint(vec4 x) { return uvec4(__to_uint(x.x), __to_uint(x.y), __to_uint(x.z), __to_uint(x.w)); }
