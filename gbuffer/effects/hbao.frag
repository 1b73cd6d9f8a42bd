#version 430
// Horizon-based ambient occlusion as NVIDIA ships it (HBAO+; gl_ssao): no horizon is kept, every tap occludes by itself.
#include "taps.glsl"
#include "noise.glsl"
#include "vec.glsl"

layout(location = 0) out float visibility;

// saturate(n.v / |v| - bias) saturate(1 - |v|^2 / R^2), v from the surface to the tap
float occlusion_of(vec3 v, vec3 n) {
    float v2 = dot(v, v), sine = dot(n, v) * inversesqrt(max(v2, TINY));
    return clamp(sine - BIAS, 0.0, 1.0) * clamp(1.0 - v2 / (RADIUS * RADIUS), 0.0, 1.0);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy), pixel = surface_pixel(texel, target_size.xy);
    Surface s = read_gbuffer(pixel);
    vec3 p = s.position, n = normal_of(s, pixel), noise = noise_at(texel);
    // The picture of the radius is halved here, and not in the weight above: gl_ssao's own choice.
    float radius = 0.5 * RADIUS * pixels_per_metre(-p.z), apart = radius / float(STEPS + 1), sum = 0.0;
    for (int k = 0; k < DIRECTIONS; ++k) {
        float angle = 2.0 * PI * (float(k) + noise.x) / float(DIRECTIONS);
        vec2 way = vec2(cos(angle), sin(angle));
        for (int i = 0; i < STEPS; ++i) {
            ivec2 tap = pixel + ivec2(round((apart * (float(i) + noise.y) + 1.0) * way));
            float depth = depth_of(tap);
            sum += depth > 0.0 ? occlusion_of(at_depth(tap, depth) - p, n) : 0.0;
        }
    }
    // AO = saturate(1 - 2 sum / (taps (1 - bias)))
    float occlusion = sum / (float(DIRECTIONS * STEPS) * (1.0 - BIAS));
    visibility = is_covered(pixel) ? clamp(1.0 - 2.0 * occlusion, 0.0, 1.0) : 1.0;
}
