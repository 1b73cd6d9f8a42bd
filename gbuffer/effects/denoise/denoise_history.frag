#version 430
// This frame's rays, and what earlier frames brought to the same surface: where it was, by the camera's motion; not where
// its depth or its normal was another.
#include "guides.glsl"

uniform sampler2D denoise_noisy, denoise_guide_before, denoise_history_before;
layout(location = 0) out vec4 history;  // and the number of frames in it

// Luma and chroma, between whose bounds colours are clamped (Karis, High Quality Temporal Supersampling, 2014).
vec3 to_ycocg(vec3 c) {
    return vec3(dot(c, vec3(0.25, 0.5, 0.25)), dot(c, vec3(0.5, 0.0, -0.5)), dot(c, vec3(-0.25, 0.5, -0.25)));
}
vec3 from_ycocg(vec3 c) { return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z); }

vec3 clamped(vec3 before, ivec2 pixel) {
    vec3 least = vec3(1e30), most = vec3(-1e30), sum = vec3(0.0), squares = vec3(0.0);
    float total = 0.0;
    for (int k = 0; k < 9; ++k) {
        ivec2 tap = pixel + ivec2(k % 3 - 1, k / 3 - 1);
        if (guide_at(tap).w <= 0.0) continue;
        vec3 c = to_ycocg(texelFetch(denoise_noisy, tap, 0).rgb);
        least = min(least, c);
        most = max(most, c);
        sum += c;
        squares += c * c;
        total += 1.0;
    }
#if CLAMP == 2
    vec3 mean = sum / total, sigma = sqrt(max(squares / total - mean * mean, 0.0));
    least = mean - SIGMAS * sigma;
    most = mean + SIGMAS * sigma;
#endif
    return from_ycocg(clamp(to_ycocg(before), least, most));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 guide = guide_at(pixel);
    history = vec4(0.0);
    if (guide.w <= 0.0) return;
    vec2 screen = (vec2(pixel) + 0.5) / size.xy * 2.0 - 1.0, slope = abs(depth_slope(pixel, guide.w));
    vec4 before = previous_clip * vec4(position_from_linear_depth(screen, guide.w, eye_ray.xy), 1.0);
    // w is the depth that the point had.
    vec2 place = (before.xy / before.w * 0.5 + 0.5) * size.xy - 0.5, corner = floor(place);
    float tolerance = DEPTH_TIMES * (max(slope.x, slope.y) + DEPTH_MORE), total = 0.0;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; ++k) {
        ivec2 tap = ivec2(corner) + ivec2(k & 1, k >> 1);
        if (!is_inside(tap)) continue;
        vec4 other = texelFetch(denoise_guide_before, tap, 0);
        vec2 share = max(1.0 - abs(vec2(tap) - place), 0.0);
        bool same = other.w > 0.0 && abs(other.w - before.w) <= tolerance && dot(other.xyz, guide.xyz) >= SAME;
        float weight = same ? share.x * share.y : 0.0;
        sum += weight * texelFetch(denoise_history_before, tap, 0);
        total += weight;
    }
    vec3 now = texelFetch(denoise_noisy, pixel, 0).rgb;
    if (total <= 0.0) {
        history = vec4(now, 1.0);
        return;
    }
    sum /= total;
    float frames = min(sum.w + 1.0, MOST_FRAMES);
    vec3 earlier = CLAMP != 0 ? clamped(sum.rgb, pixel) : sum.rgb;
    history = vec4(mix(earlier, now, max(1.0 / frames, LEAST_SHARE)), frames);
}
