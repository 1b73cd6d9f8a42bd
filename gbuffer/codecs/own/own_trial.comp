#version 430
// What a user's two functions make of anything, without storage. OWN_ENCODE and OWN_FIRST, OWN_SECOND, OWN_THIRD are their
// adapters, vec4 of vec4 and vec3; OWN_RESULTS says how many the decoder has. The fourth number of `given_more` is 1 where
// the code to decode is given as well. A done is 1 where the device has not ended the loops of a function.
#include "rotation.glsl"
#include "loop_turns.glsl"
#include OWN_CODE

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Given { vec4 given[]; };
layout(std430, binding = 1) readonly buffer GivenMore { vec4 given_more[]; };
layout(std430, binding = 2) readonly buffer GivenCodes { vec4 given_codes[]; };
layout(std430, binding = 3) writeonly buffer Codes { vec4 codes[]; };
layout(std430, binding = 4) writeonly buffer First { vec4 first[]; };
layout(std430, binding = 5) writeonly buffer Second { vec4 second[]; };
layout(std430, binding = 6) writeonly buffer Third { vec4 third[]; };
layout(std430, binding = 7) writeonly buffer EncodeDone { vec4 encode_done[]; };
layout(std430, binding = 8) writeonly buffer DecodeDone { vec4 decode_done[]; };

float done() { return turns_made() == asked_turns ? 1.0 : 2.0; }

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= given.length()) return;
    vec4 more = given_more[i];
    vec4 code = OWN_ENCODE(given[i], more.xyz);
    codes[i] = code;
    // What is not used would not be computed.
    float is_done = done();
    encode_done[i] = vec4(is_done, code.xyz);
    code = more.w > 0.0 ? given_codes[i] : code;
    vec4 back = OWN_FIRST(code, more.xyz);
    first[i] = back;
#if OWN_RESULTS > 1
    second[i] = OWN_SECOND(code, more.xyz);
#endif
#if OWN_RESULTS > 2
    third[i] = OWN_THIRD(code, more.xyz);
#endif
    decode_done[i] = vec4(done(), back.xyz);
}
