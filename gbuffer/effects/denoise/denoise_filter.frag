#version 430
// One pass of the a-trous filter: 5 x 5 pixels `stride` apart,
//     sum h(q) w(p, q) c(q) / sum h(q) w(p, q),  w = w_z w_n w_r
// of depths, normals and, of reflections, roughnesses (Schied et al. 2017, equations 1 to 4).
#include "guides.glsl"

uniform sampler2D denoise_roughness;
#if IS_FIRST
uniform sampler2D denoise_history;
#define SOURCE denoise_history
layout(location = 1) out float neighbours;
#else
uniform sampler2D denoised_before;
#define SOURCE denoised_before
#endif
uniform int stride;
layout(location = 0) out vec4 denoised;

const float kernel[] = float[](0.375, 0.25, 0.0625);

// x^k by squaring: a device's own pow is not exact where x is 1.
float whole_power(float x, int k) {
    float result = 1.0;
    for (; k > 0; k >>= 1) {
        if ((k & 1) != 0) result *= x;
        x *= x;
    }
    return result;
}

// NRD's weight: falls from 1 to 0 over the angle of the cone that holds LOBE_SHARE of GGX's lobe,
//     tan(angle) = roughness sqrt(LOBE_SHARE / (1 - LOBE_SHARE))
float cone_weight(float cosine, float roughness) {
    float angle = max(atan(roughness * sqrt(LOBE_SHARE / (1.0 - LOBE_SHARE))), LEAST_ANGLE);
    return 1.0 - smoothstep(0.0, 1.0, acos(clamp(cosine, -1.0, 1.0)) / angle);
}

float normal_weight(vec3 n, vec3 other, float roughness) {
    float cosine = dot(n, other);
    return WEIGHTS_BY != 0 ? cone_weight(cosine, roughness) : whole_power(max(cosine, 0.0), POWER_OF_NORMALS);
}

float roughness_weight(float roughness, float other) {
    float apart = mix(LEAST_ROUGHNESS_APART, 1.0, clamp(roughness * ROUGHNESS_SHARE, 0.0, 1.0));
    return READS_ROUGHNESS != 0 ? exp(-3.0 * abs(roughness - other) / apart) : 1.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 guide = guide_at(pixel);
    denoised = vec4(0.0);
#if IS_FIRST
    neighbours = 0.0;
#endif
    if (guide.w <= 0.0) return;
    // Occlusion gathers light from all the hemisphere, as a surface of roughness 1 does.
    float roughness = READS_ROUGHNESS != 0 ? texelFetch(denoise_roughness, pixel, 0).x : 1.0;
    vec2 slope = depth_slope(pixel, guide.w);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int k = 0; k < 25; ++k) {
        ivec2 over = ivec2(k % 5 - 2, k / 5 - 2), tap = pixel + stride * over;
        vec4 other = guide_at(tap);
        if (other.w <= 0.0) continue;
        bool itself = over == ivec2(0);
        float weight = kernel[abs(over.x)] * kernel[abs(over.y)];
        if (!itself) {
            float apart = SLOPES * abs(dot(slope, vec2(stride * over))) + LEAST_DEPTH * guide.w;
            weight *= exp(-abs(guide.w - other.w) / apart) * normal_weight(guide.xyz, other.xyz, roughness);
            weight *= roughness_weight(roughness, texelFetch(denoise_roughness, tap, 0).x);
        }
        sum += weight * texelFetch(SOURCE, tap, 0).rgb;
        total += weight;
    }
    denoised = vec4(sum / total, 1.0);
#if IS_FIRST
    neighbours = total - kernel[0] * kernel[0];
#endif
}
