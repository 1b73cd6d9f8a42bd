// What calls a user's function as a shader: in HLSL, and in Slang.
RESULT normalbench_entry([[vk::location(0)]] GIVEN normalbench_given : TEXCOORD0,
                         [[vk::location(1)]] float3 normalbench_view : TEXCOORD1) : SV_Target0 {
    return FUNCTION(ARGUMENTS);
}
