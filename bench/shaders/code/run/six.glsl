// The six functions, for desktop OpenGL and OpenGL ES.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer RunGiven { vec4 run_given[]; };
layout(std430, binding = 1) writeonly buffer RunMade { vec4 run_made[]; };
layout(std430, binding = 2) writeonly buffer RunWords { uvec4 run_words[]; };

vec4 run_row(vec2 v) { return vec4(v, 0.0, 0.0); }
vec4 run_row(vec3 v) { return vec4(v, 0.0); }
uvec4 run_row(uint word) { return uvec4(word, 0u, 0u, 0u); }
uvec4 run_row(uvec2 words) { return uvec4(words, 0u, 0u); }
uvec4 run_row(uvec4 words) { return words; }

#if RUN_VIEW
#define RUN_WITH_VIEW , run_given[3u * i + 1u].xyz
#else
#define RUN_WITH_VIEW
#endif
#if RUN_SIGN
#define RUN_WITH_SIGN , code[RUN_SIZE - 1]
#else
#define RUN_WITH_SIGN
#endif
#if RUN_SIZE == 2
#define RUN_CODE vec2
#else
#define RUN_CODE vec3
#endif
#if RUN_WORDS == 1
#define RUN_TEXEL uint
#elif RUN_WORDS == 2
#define RUN_TEXEL uvec2
#else
#define RUN_TEXEL uvec4
#endif

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(run_given.length()) / 3u) return;
    RUN_CODE code = RUN_ENCODE(run_given[3u * i].xyz RUN_WITH_VIEW);
    RUN_TEXEL words = RUN_PACK(code);
    RUN_CODE unpacked = RUN_UNPACK(words ^ floatBitsToUint(run_given[3u * i].w) RUN_WITH_SIGN);
    run_words[i] = run_row(words);
    run_made[5u * i] = run_row(code);
    run_made[5u * i + 1u] = run_row(unpacked);
    run_made[5u * i + 2u] = run_row(RUN_DECODE(unpacked RUN_WITH_VIEW));
    run_made[5u * i + 3u] = RUN_TO_TARGET(code);
    run_made[5u * i + 4u] = run_row(RUN_FROM_TARGET(run_given[3u * i + 2u] RUN_WITH_SIGN));
}
