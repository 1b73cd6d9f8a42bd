#version 430
// Scalable ambient obscurance (McGuire, Mara and Luebke 2012): taps on a spiral around the pixel.
#include "taps.glsl"
#include "noise.glsl"
#include "vec.glsl"

layout(location = 0) out float visibility;

// max(0, r^2 - v.v)^3 max(0, v.n - bias) / (epsilon + v.v), over r^6
float obscurance_of(vec3 v, vec3 n) {
    float v2 = dot(v, v), f = max(1.0 - v2 / (RADIUS * RADIUS), 0.0);
    return f * f * f * max((dot(v, n) - BIAS) / (EPSILON + v2), 0.0);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy), pixel = surface_pixel(texel, target_size.xy);
    Surface s = read_gbuffer(pixel);
    vec3 p = s.position, n = normal_of(s, pixel);
    float radius = RADIUS * pixels_per_metre(-p.z), spin = noise_at(texel).x, sum = 0.0;
    for (int i = 0; i < TAPS; ++i) {
        float share = (float(i) + 0.5) / float(TAPS), angle = 2.0 * PI * (share * float(TURNS) + spin);
        ivec2 tap = pixel + ivec2(round(share * radius * vec2(cos(angle), sin(angle))));
        float depth = depth_of(tap);
        sum += depth > 0.0 ? obscurance_of(at_depth(tap, depth) - p, n) : 0.0;
    }
    // A = max(0, 1 - 5 sigma / (r^6 taps) sum)
    float found = max(1.0 - 5.0 * STRENGTH * sum / float(TAPS), 0.0);
    visibility = is_covered(pixel) && radius > LEAST ? found : 1.0;
}
