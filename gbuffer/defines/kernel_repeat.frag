#version 430
// One operation over and over, for a clock. `kernel_nothing` is 0, which the compiler does not know: each turn's inputs
// differ. All of them are written in the end, so that none is left out for want of a use.
#include OPERATION

uniform sampler2D kernel_givens;
uniform sampler2D kernel_besides;
uniform int kernel_turns;
uniform float kernel_nothing;
layout(location = 0) out vec4 kernel_result;
layout(location = 1) out vec4 kernel_kept;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GIVEN given = GIVEN(texelFetch(kernel_givens, pixel, 0));
    BESIDE beside = BESIDE(texelFetch(kernel_besides, pixel, 0));
    MADE sum = MADE(0.0);
    for (int turn = 0; turn < kernel_turns; ++turn) {
        sum += kernel_operation(given, beside);
        given += kernel_nothing;
        beside += kernel_nothing;
    }
    kernel_result = vec4(0.0);
    kernel_kept = vec4(0.0);
    for (int i = 0; i < sum.length(); ++i) kernel_result[i] = sum[i];
    for (int i = 0; i < given.length(); ++i) kernel_kept.x += given[i];
    for (int i = 0; i < beside.length(); ++i) kernel_kept.y += beside[i];
}
