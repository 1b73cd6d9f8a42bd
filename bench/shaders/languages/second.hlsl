// What calls a user's two functions on rows of four numbers for each normal: normal, view and a code.
[[vk::binding(0, 0)]] StructuredBuffer<float4> normalbench_given;
[[vk::binding(1, 0)]] RWStructuredBuffer<float4> normalbench_made;
[shader("compute")]
[numthreads(1, 1, 1)]
void normalbench_second(uint3 normalbench_id : SV_DispatchThreadID) {
    uint normalbench_row = 3u * normalbench_id.x;
    float4 normalbench_n = normalbench_given[normalbench_row], normalbench_view = normalbench_given[normalbench_row + 1u];
    float4 normalbench_code = normalbench_given[normalbench_row + 2u];
    normalbench_made[2u * normalbench_id.x] = float4(ENCODE(normalbench_n.xyz VIEW_E), ZEROS_E);
    normalbench_made[2u * normalbench_id.x + 1u] = float4(DECODE(normalbench_code.CODE VIEW_D), 0.0);
}
