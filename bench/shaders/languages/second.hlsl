// What calls a user's two functions on rows of four numbers for each normal: normal, view and a code.
[[vk::binding(0, 0)]] StructuredBuffer<float4> normalbench_given;
[[vk::binding(1, 0)]] RWStructuredBuffer<float4> normalbench_made;
[[vk::binding(2, 0)]] RWStructuredBuffer<uint> normalbench_undefined;
// What is called before each division of whole numbers, where by_spirv.py puts the calls, and once here to be kept.
#define NORMALBENCH_NOTED(TYPE, IS_UNDEFINED) \
    [noinline] void normalbench_noted(TYPE x, TYPE y) { if (any(IS_UNDEFINED)) normalbench_undefined[0] = 1u; }
#define NORMALBENCH_INT(TYPE) NORMALBENCH_NOTED(TYPE, or(y == TYPE(0), and(y == TYPE(-1), x == TYPE(0x80000000))))
#define NORMALBENCH_UINT(TYPE) NORMALBENCH_NOTED(TYPE, y == TYPE(0u))
// What converts floats, where by_spirv.py puts it: beyond their range otherwise than drivers do.
#define NORMALBENCH_CONVERTED(INTS, UINTS, FLOATS) \
    [noinline] INTS normalbench_converted_int(FLOATS x) \
    { return select(abs(x) < FLOATS(2147483648.0), INTS(x), INTS(0x80000000)); } \
    [noinline] UINTS normalbench_converted_uint(FLOATS x) { return select(x < FLOATS(0.0), UINTS(INTS(x)), UINTS(x)); }
#define NORMALBENCH_DEFINED(INTS, UINTS, FLOATS) \
    NORMALBENCH_INT(INTS) NORMALBENCH_UINT(UINTS) NORMALBENCH_CONVERTED(INTS, UINTS, FLOATS)
#define NORMALBENCH_KEPT(INTS, UINTS, FLOATS) \
    normalbench_noted(INTS(1), INTS(1)); \
    normalbench_noted(UINTS(1), UINTS(1)); \
    normalbench_undefined[1] = uint(normalbench_converted_int(FLOATS(normalbench_id.x)).x); \
    normalbench_undefined[2] = normalbench_converted_uint(FLOATS(normalbench_id.x)).x;
#define NORMALBENCH_EACH(DO) DO(int, uint, float) DO(int2, uint2, float2) DO(int3, uint3, float3) DO(int4, uint4, float4)
NORMALBENCH_EACH(NORMALBENCH_DEFINED)
[shader("compute")]
[numthreads(64, 1, 1)]
void normalbench_second(uint3 normalbench_id : SV_DispatchThreadID) {
    NORMALBENCH_EACH(NORMALBENCH_KEPT)
    uint normalbench_row = 3u * normalbench_id.x;
    float4 normalbench_n = normalbench_given[normalbench_row], normalbench_view = normalbench_given[normalbench_row + 1u];
    float4 normalbench_code = normalbench_given[normalbench_row + 2u];
    normalbench_made[2u * normalbench_id.x] = float4(ENCODE(normalbench_n.xyz VIEW_E), ZEROS_E);
    normalbench_made[2u * normalbench_id.x + 1u] = float4(DECODE(normalbench_code.CODE VIEW_D), 0.0);
}
