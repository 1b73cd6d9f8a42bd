#version 430
// The sum of the first `count` waves over one patch: height and slope, and how the slope changes; beside water_waves.py.
#include "elementary.glsl"

uniform vec4 waves[WAVE_COUNT];  // number along x and z, height, phase in turns
uniform int count;
uniform float patch_size;
layout(location = 0) out vec4 water_heights;  // eta, d eta / dx, d eta / dz
layout(location = 1) out vec4 water_bends;    // d2 eta / dx2, d2 eta / dx dz, d2 eta / dz2

void main() {
    vec2 at = gl_FragCoord.xy / float(TEXELS);
    vec3 sum = vec3(0.0), bend = vec3(0.0);
    for (int i = 0; i < count; ++i) {
        vec4 wave = waves[i];
        float turn = fract(dot(wave.xy, at) - wave.w);
        vec2 sine = sincos_pi(turn < 0.5 ? 2.0 * turn : 2.0 * turn - 2.0), k = TURN * wave.xy / patch_size;
        // eta = a cos, its slope -a k sin, its second derivatives -a k k cos
        sum += wave.z * vec3(sine.y, -k * sine.x);
        bend -= wave.z * sine.y * vec3(k.x * k.x, k.x * k.y, k.y * k.y);
    }
    water_heights = vec4(sum, 0.0);
    water_bends = vec4(bend, 0.0);
}
