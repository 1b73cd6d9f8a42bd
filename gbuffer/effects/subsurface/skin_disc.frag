#version 430
// Light of skin by normalised diffusion (Christensen and Burley 2015), from taps on a disc at the golden angle.
#include "skin.glsl"
#include "noise.glsl"

const float radii[] = RADII;          // of the taps, in millimetres
const float distances[] = DISTANCES;  // d of red, green and blue
layout(location = 0) out vec4 blurred;

// d r R(r) times a factor that all share: R(r) = (e^(-r/d) + e^(-r/3d)) / (8 pi d r)
float spread(float r, float d) { return exp(-r / d) + exp(-r / (3.0 * d)); }

// R(sqrt(r^2 + dz^2)) of each channel over the density of the taps, which is R(r) of the widest.
vec3 weight_at(float r, float dz) {
    float far = sqrt(r * r + dz * dz), density = spread(r, WIDEST) / (WIDEST * r);
    vec3 weight;
    for (int c = 0; c < 3; ++c) weight[c] = spread(far, distances[c]) / (distances[c] * far * density);
    return weight;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 own = skin_at(pixel);
    float scale = pixels_per_millimetre(own.w), turn = noise_at(pixel).x;
    vec3 sum = vec3(0.0), total = vec3(0.0);
    for (int i = 0; i < SAMPLES_TAKEN; ++i) {
        float angle = TURN * fract(turn + GOLDEN * float(i));
        vec2 place = gl_FragCoord.xy + radii[i] * scale * vec2(cos(angle), sin(angle));
        vec4 there = skin_at(ivec2(floor(place)));
        vec3 weight = there.w > 0.0 ? weight_at(radii[i], FOLLOW * (there.w - own.w) / METRES) : vec3(0.0);
        sum += weight * there.rgb;
        total += weight;
    }
    // Of skin that no tap finds, what lies there stays.
    blurred = vec4(mix(own.rgb, sum / max(total, TINY), greaterThan(total, vec3(0.0))), own.w);
}
