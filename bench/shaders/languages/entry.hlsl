// What calls a user's function as a shader: in HLSL, and in Slang.
RESULT normalbench_entry([[vk::location(0)]] GIVEN normalbench_given : TEXCOORD0 VIEW) : SV_Target0 {
    return FUNCTION(ARGUMENTS);
}
