#version 430
// Light from the volumes at each pixel of the G-buffer, times 1 / pi.
#include "gbuffer.glsl"
#include "lpv_places.glsl"
#include "lpv_harmonics.glsl"
#include "lpv_packed.glsl"

uniform sampler3D lpv_light_red, lpv_light_green, lpv_light_blue;
out vec4 indirect;

// Intensity towards `basis`, trilinear between the centres of cells; `place` is in cells. By hand: the blending of a
// device's samplers has weights of 8 bits, and packed texels do not blend.
vec3 intensity(vec3 place, vec4 basis, int cascade) {
    vec3 corner = floor(place - 0.5), share = place - 0.5 - corner, sum = vec3(0.0);
    for (int i = 0; i < 8; ++i) {
        ivec3 right = ivec3(i & 1, i >> 1 & 1, i >> 2);
        ivec3 at = clamp(ivec3(corner) + right, ivec3(0), ivec3(CELLS - 1)) + ivec3(0, 0, CELLS * cascade);
        vec3 part = mix(1.0 - share, share, vec3(right));
        mat3x4 there = mat3x4(wave_of(texelFetch(lpv_light_red, at, 0)), wave_of(texelFetch(lpv_light_green, at, 0)),
                              wave_of(texelFetch(lpv_light_blue, at, 0)));
        sum += part.x * part.y * part.z * (basis * there);
    }
    return sum;
}

// How much a cascade has to say at a place: 1, falling to 0 over `border` cells towards its end.
float weight(vec3 place, float border) {
    vec3 inside = min(place, float(CELLS) - place);
    return clamp(min(inside.x, min(inside.y, inside.z)) / border, 0.0, 1.0);
}

void main() {
    Surface s = read_gbuffer(ivec2(gl_FragCoord.xy));
    vec3 n = in_world(s.direction), sum = vec3(0.0);
    // A strand is lit from all around alike: its sine is even, and the second band is odd.
    bool is_strand = HAS_KIND != 0 && s.kind == HAIR;
    vec4 basis = is_strand ? vec4(SH0, vec3(0.0)) : harmonics(-n);
    float left = is_covered(-s.position.z) ? 1.0 : 0.0;
    for (int cascade = 0; cascade < CASCADES; ++cascade) {
        vec3 place = in_cells(s.position, cascade) + (is_strand ? vec3(0.0) : 0.5 * n);
        // The last one fades over its outermost cell alone: nothing lies behind it.
        float share = left * weight(place, cascade + 1 < CASCADES ? BLEND_CELLS : 1.0);
        if (share <= 0.0) continue;
        // L = I / (s / 2)^2: the light of a cell is taken to come from half a cell away
        float near = 0.5 * cell_of(cascade);
        sum += share * max(intensity(place, basis, cascade), 0.0) / (near * near);
        left -= share;
    }
    indirect = vec4(sum, 1.0);
}
