#version 430
// Light of skin, blurred along rows or columns of pixels, with red, green and blue each by weights of its own.
#include "skin.glsl"

const float kernel[] = KERNEL;  // weights of red, green and blue, and an offset in millimetres
#if GAUSSIANS
#include "skin_sum.glsl"
#endif
layout(location = 0) out vec4 blurred;

// What a pixel gives to another one. In place of light from across a step in depth, and from what is not skin, the other
// keeps its own: none is lost, and none comes in (SeparableSSS.h, SSSS_FOLLOW_SURFACE).
vec3 given(ivec2 from, vec4 to) {
    vec4 there = skin_at(from);
    float apart = there.w > 0.0 ? min(FOLLOW * abs(there.w - to.w), 1.0) : 1.0;
    return mix(there.rgb, to.rgb, apart);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), way = ivec2(ALONG_X, 1 - ALONG_X);
    vec4 own = skin_at(pixel);
    float scale = pixels_per_millimetre(own.w);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < SAMPLES_TAKEN; ++i) {
        float place = kernel[4 * i + 3] * scale, before = floor(place);
        ivec2 from = pixel + int(before) * way;
        vec3 weight = vec3(kernel[4 * i], kernel[4 * i + 1], kernel[4 * i + 2]);
        sum += weight * mix(given(from, own), given(from + way, own), place - before);
    }
#if GAUSSIANS
    sum = sum_of_gaussians(pixel, sum);
#endif
    blurred = vec4(sum, own.w);
}
