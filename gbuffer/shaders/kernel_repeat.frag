#version 430
// One operation over and over, for a clock. `nothing` is 0, which the compiler does not know: each turn's inputs differ.
// All of them are written in the end, so that none is left out for want of a use.
#include OPERATION

uniform sampler2D givens;
uniform sampler2D besides;
uniform int turns;
uniform float nothing;
layout(location = 0) out vec4 result;
layout(location = 1) out vec4 kept;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GIVEN given = GIVEN(texelFetch(givens, pixel, 0));
    BESIDE beside = BESIDE(texelFetch(besides, pixel, 0));
    MADE sum = MADE(0.0);
    for (int turn = 0; turn < turns; ++turn) {
        sum += operation(given, beside);
        given += nothing;
        beside += nothing;
    }
    result = vec4(0.0);
    kept = vec4(0.0);
    for (int i = 0; i < sum.length(); ++i) result[i] = sum[i];
    for (int i = 0; i < given.length(); ++i) kept.x += given[i];
    for (int i = 0; i < beside.length(); ++i) kept.y += beside[i];
}
