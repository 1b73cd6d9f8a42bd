#version 430
// Encodes textures of tangent frames into the render target under test.
#include "frame_code.glsl"
#define STORAGE_ROUNDS_TWICE
#include "storage.glsl"
#include "dither.glsl"

uniform sampler2D normals;  // normal, hand
uniform sampler2D tangents;
layout(location = 0) out vec4 texel;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 normal = texelFetch(normals, pixel, 0);
    Frame frame = frame_of(normal.xyz, texelFetch(tangents, pixel, 0).xyz, normal.w);
    vec4 code = FRAME_ENCODE(frame, FRAME_LEAST);
    vec4 noisy = dithered(code);
#if FRAME_SETTLES
    vec4 stored = unbiased(round_texel(biased(noisy)));
    code = FRAME_SETTLE(frame, stored);
    noisy = dithered(code);
    // A number that is stored already stays: cut off again, or with more noise, it could lose a step.
    for (int i = 0; i < 4; ++i) {
        if (code[i] != stored[i]) continue;
        storage_rounding[i] = 0;
        noisy[i] = stored[i];
    }
#endif
    texel = to_texel(noisy);
}
