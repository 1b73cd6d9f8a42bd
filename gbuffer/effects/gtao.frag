#version 430
// Ground-truth ambient occlusion (Jimenez et al. 2016; steps and fall-off of XeGTAO).
#include "taps.glsl"
#include "noise.glsl"
#include "gtao.glsl"

layout(location = 0) out float visibility;
layout(location = 1) out vec4 bent_normal;

// The cosine of a tap's horizon, drawn to the open one as it gets farther; the open one where nothing is, and where the
// way into a slice that hardly meets the tangent plane leads to the other side of P. `side` is 1 where o points, else -1.
float horizon(ivec2 pixel, vec3 p, Slice s, float side, vec3 v, float open) {
    float depth = depth_of(pixel);
    vec3 way = at_depth(pixel, depth) - p;
    float w = clamp((RADIUS - length(way)) / (FALL_OFF * RADIUS), 0.0, 1.0);
    vec3 moved = into_slice(s, way);
    bool there = depth > 0.0 && side * dot(moved, s.across) > 0.0;
    return there ? max(open, mix(open, dot(unit(moved), v), w)) : open;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy), pixel = surface_pixel(texel, target_size.xy);
    Surface surface = read_gbuffer(pixel);
    vec3 p = surface.position * NEARER, n = normal_of(surface, pixel), v = unit(-p), noise = noise_at(texel);
    float radius = RADIUS * pixels_per_metre(-p.z), seen = 0.0, all = 0.0;
    vec3 bent = vec3(0.0);
    for (int k = 0; k < SLICES; ++k) {
        float phi = PI * (float(k) + noise.x) / float(SLICES);
        Slice s = slice_at(phi, n, v);
        vec2 open = open_horizons(s), horizons = open, along = radius * s.on_screen;
        for (int i = 0; i < STEPS; ++i) {
            float place = (float(i) + fract(noise.y + GOLDEN * float(k + i * STEPS))) / float(STEPS);
            ivec2 offset = ivec2(round((pow(place, STEP_POWER) + FIRST / radius) * along));
            horizons.x = max(horizons.x, horizon(pixel - offset, p, s, -1.0, v, open.x));
            horizons.y = max(horizons.y, horizon(pixel + offset, p, s, 1.0, v, open.y));
        }
        seen += slice_visibility(s, horizons);
        all += slice_visibility(s, open);
        bent += slice_bent_normal(s, horizons, v);
    }
    // Few slices of an open view have a mean other than 1: what is seen is a share of what these slices could see.
    bool covered = is_covered(pixel);
    visibility = covered ? pow(clamp(seen / all, 0.0, 1.0), FINAL_POWER) : 1.0;
    bent_normal = vec4(covered ? unit(bent) : vec3(0.0), 0.0);
}
