// The six functions of a file of HLSL or Slang, on three rows of four numbers for each normal: normal, view and a texel.
#include CODE

[[vk::binding(0, 0)]] StructuredBuffer<float4> run_given;
[[vk::binding(1, 0)]] RWStructuredBuffer<float4> run_made;
[[vk::binding(2, 0)]] RWStructuredBuffer<uint4> run_words;

uint4 run_words_of(uint word) { return uint4(word, 0u, 0u, 0u); }
uint4 run_words_of(uint2 words) { return uint4(words, 0u, 0u); }
uint4 run_words_of(uint4 words) { return words; }

#if RUN_SIGN
#define RUN_WITH_SIGN , code[RUN_SIZE - 1]
#else
#define RUN_WITH_SIGN
#endif
#if RUN_SIZE == 1
#define RUN_CODE float
#elif RUN_SIZE == 2
#define RUN_CODE float2
#elif RUN_SIZE == 3
#define RUN_CODE float3
#else
#define RUN_CODE float4
#endif
#ifdef RUN_STRUCTURE
#define RUN_KIND RUN_STRUCTURE
#elif RUN_RESULT == 1
#define RUN_KIND float
#elif RUN_RESULT == 2
#define RUN_KIND float2
#elif RUN_RESULT == 3
#define RUN_KIND float3
#else
#define RUN_KIND float4
#endif
#if RUN_WORDS == 1
#define RUN_TEXEL uint
#elif RUN_WORDS == 2
#define RUN_TEXEL uint2
#else
#define RUN_TEXEL uint4
#endif

[shader("compute")]
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    uint rows, stride, i = id.x;
    run_given.GetDimensions(rows, stride);
    if (i >= rows / 3u) return;
    float4 n = run_given[3u * i], view = run_given[3u * i + 1u];
    RUN_CODE code = RUN_ENCODE(RUN_VALUE);
    RUN_TEXEL words = RUN_PACK(code);
    RUN_CODE unpacked = RUN_UNPACK(words ^ asuint(view.w) RUN_WITH_SIGN);
    RUN_KIND decoded = RUN_DECODE(unpacked RUN_SETTINGS);
    run_words[i] = run_words_of(words);
    run_made[6u * i] = float4(code RUN_REST);
    run_made[6u * i + 1u] = float4(unpacked RUN_REST);
    run_made[6u * i + 2u] = float4(RUN_FIRST);
    run_made[6u * i + 3u] = RUN_TO_TARGET(code);
    run_made[6u * i + 4u] = float4(RUN_FROM_TARGET(run_given[3u * i + 2u] RUN_WITH_SIGN) RUN_REST);
    run_made[6u * i + 5u] = float4(RUN_SECOND);
}
