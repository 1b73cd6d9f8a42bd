// By hand, for tests of the runners: a code with a view, a table, a sign and two words. Every step is exact.
uniform highp sampler2D scaled_steps;

float scaled_rg32f_step(float z) { return texelFetch(scaled_steps, ivec2(z < 0.0 ? 1 : 0, 0), 0).y; }

vec3 scaled_rg32f_encode(vec3 n, vec3 view) {
    return vec3(n.xy * scaled_rg32f_step(n.z) + view.xy, n.z < 0.0 ? -1.0 : 1.0);
}
uvec2 scaled_rg32f_pack(vec3 code) { return floatBitsToUint(code.xy); }
vec3 scaled_rg32f_unpack(uvec2 words, float sign) { return vec3(uintBitsToFloat(words), sign); }
vec3 scaled_rg32f_decode(vec3 e, vec3 view) { return vec3((e.xy - view.xy) / scaled_rg32f_step(e.z), e.z); }
vec4 scaled_rg32f_to_target(vec3 code) { return vec4(code.xy, 0.0, 1.0); }
vec3 scaled_rg32f_from_target(vec4 texel, float sign) { return vec3(texel.xy, sign); }
