#version 430
// One step of propagation (Kaplanyan and Dachsbacher 2010): a cell gathers from its six neighbours. What
// passes the face towards it meets five other faces of this cell, and each emits it as a cosine lobe. Intensity is not
// clamped at 0: so no flux is made, and light of many sources is the sum of each one's.
#include "lpv_packed.glsl"
#include "lpv_harmonics.glsl"

uniform sampler3D lpv_wave_red_before, lpv_wave_green_before, lpv_wave_blue_before;
uniform sampler3D lpv_light_red_before, lpv_light_green_before, lpv_light_blue_before;
uniform int slice;
layout(location = 0) out vec4 wave[3];
layout(location = 3) out vec4 light[3];

const ivec3 axes[6] = ivec3[6](ivec3(1, 0, 0), ivec3(-1, 0, 0), ivec3(0, 1, 0), ivec3(0, -1, 0), ivec3(0, 0, 1),
                               ivec3(0, 0, -1));

#if BLOCKS
uniform sampler2D lpv_blockers;
vec4 corners[8];

void read_corners(ivec3 cell, int cascade) {
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = cell + ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec4 b = texelFetch(lpv_blockers, ivec2(corner.x + CORNERS * corner.z, corner.y + CORNERS * cascade), 0);
        // Several views add their surfels up; together they are no more than one that fills a face.
        corners[i] = b * min(LOBE0 / max(b.x, TINY), 1.0);
    }
}

// In the middle of the cell's face on the side of `way`: the mean of its four corners.
vec4 at_face(ivec3 way) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; ++i) {
        ivec3 side = 2 * ivec3(i & 1, i >> 1 & 1, i >> 2) - 1;
        sum += dot(vec3(side), vec3(way)) > 0.0 ? corners[i] : vec4(0.0);
    }
    return sum / 4.0;
}

// The share that passes on its way towards w.
float passing(vec4 blockers, vec3 w) { return 1.0 - clamp(AMPLIFIER * dot(blockers, harmonics(-w)), 0.0, 1.0); }
#endif

void main() {
    int cascade = slice / CELLS;
    ivec3 cell = ivec3(gl_FragCoord.xy, slice % CELLS), down = ivec3(0, 0, CELLS * cascade);
#if BLOCKS
    read_corners(cell, cascade);
#endif
    mat3x4 sum = mat3x4(0.0);
    for (int i = 0; i < 6; ++i) {
        ivec3 from = cell - axes[i];
        if (any(lessThan(from, ivec3(0))) || any(greaterThanEqual(from, ivec3(CELLS)))) continue;
        vec3 main_way = vec3(axes[i]);
        mat3x4 there = mat3x4(wave_of(texelFetch(lpv_wave_red_before, from + down, 0)),
                              wave_of(texelFetch(lpv_wave_green_before, from + down, 0)),
                              wave_of(texelFetch(lpv_wave_blue_before, from + down, 0)));
#if BLOCKS
        vec4 blockers = at_face(-axes[i]);
#endif
        for (int face = 0; face < 6; ++face) {
            if (axes[face] == -axes[i]) continue;
            vec3 n = vec3(axes[face]), w = face == i ? n : SIDE_AHEAD * main_way + SIDE_ASIDE * n;
            // Phi = Omega I(w)
            vec3 flux = (face == i ? FRONT_ANGLE : SIDE_ANGLE) * (harmonics(w) * there);
#if BLOCKS
            flux *= passing(blockers, w);
#endif
            sum += outerProduct(cosine_lobe(n), PER_FLUX * flux);
        }
    }
    wave = vec4[3](packed_wave(sum[0]), packed_wave(sum[1]), packed_wave(sum[2]));
    ivec3 own = cell + down;
    light[0] = packed_wave(wave_of(texelFetch(lpv_light_red_before, own, 0)) + sum[0]);
    light[1] = packed_wave(wave_of(texelFetch(lpv_light_green_before, own, 0)) + sum[1]);
    light[2] = packed_wave(wave_of(texelFetch(lpv_light_blue_before, own, 0)) + sum[2]);
}
