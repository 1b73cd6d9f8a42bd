// The six functions, for desktop OpenGL and OpenGL ES.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer RunGiven { vec4 run_given[]; };
layout(std430, binding = 1) writeonly buffer RunMade { vec4 run_made[]; };
layout(std430, binding = 2) writeonly buffer RunWords { uvec4 run_words[]; };

uvec4 run_row(uint word) { return uvec4(word, 0u, 0u, 0u); }
uvec4 run_row(uvec2 words) { return uvec4(words, 0u, 0u); }
uvec4 run_row(uvec4 words) { return words; }

#if RUN_SIGN
#define RUN_WITH_SIGN , code[RUN_SIZE - 1]
#else
#define RUN_WITH_SIGN
#endif
#if RUN_SIZE == 1
#define RUN_CODE float
#elif RUN_SIZE == 2
#define RUN_CODE vec2
#elif RUN_SIZE == 3
#define RUN_CODE vec3
#else
#define RUN_CODE vec4
#endif
#ifdef RUN_STRUCTURE
#define RUN_KIND RUN_STRUCTURE
#elif RUN_RESULT == 1
#define RUN_KIND float
#elif RUN_RESULT == 2
#define RUN_KIND vec2
#elif RUN_RESULT == 3
#define RUN_KIND vec3
#else
#define RUN_KIND vec4
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
    vec4 n = run_given[3u * i], view = run_given[3u * i + 1u];
    RUN_CODE code = RUN_ENCODE(RUN_VALUE);
    RUN_TEXEL words = RUN_PACK(code);
    RUN_CODE unpacked = RUN_UNPACK(words ^ floatBitsToUint(view.w) RUN_WITH_SIGN);
    RUN_KIND decoded = RUN_DECODE(unpacked RUN_SETTINGS);
    run_words[i] = run_row(words);
    run_made[6u * i] = vec4(code RUN_REST);
    run_made[6u * i + 1u] = vec4(unpacked RUN_REST);
    run_made[6u * i + 2u] = vec4(RUN_FIRST);
    run_made[6u * i + 3u] = RUN_TO_TARGET(code);
    run_made[6u * i + 4u] = vec4(RUN_FROM_TARGET(run_given[3u * i + 2u] RUN_WITH_SIGN) RUN_REST);
    run_made[6u * i + 5u] = vec4(RUN_SECOND);
}
