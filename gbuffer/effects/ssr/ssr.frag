#version 430
// Light that mirrored rays bring: the image's colour where they meet it, and what lies around where they meet nothing.
#include "gbuffer.glsl"
#include "environment.glsl"
#include "noise.glsl"
#include "ssr_lobe.glsl"
#include "ssr_march.glsl"

uniform SAMPLER final;
layout(location = 0) out vec4 reflected;  // and the share of the rays that meet something
layout(location = 1) out vec4 hit;        // where the first ray does, in pixels; how often the screen was looked at; 1 or 0

vec3 seen_around(Surface s) {
    if (AROUND == 0) return vec3(0.0);
    return radiance(mat3(view_to_world) * reflect(unit(s.position), s.direction), s.roughness);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    reflected = hit = vec4(0.0);
    if (texelFetch(ssr_near, pixel, 0).x <= 0.0) return;
    Surface s = read_gbuffer(pixel);
    float a = s.roughness * s.roughness, total = 0.0, met = 0.0;
    mat3 axes = axes_around(s.direction);
    vec3 v = unit(-s.position) * axes, sum = vec3(0.0);
    vec2 noise = noise_at(pixel).xy;
    // All rays of a mirror are one.
    int rays = a > 0.0 ? RAYS : 1;
    for (int i = 0; i < RAYS; ++i) {
        if (i >= rays) break;
        // A lattice of Fibonacci's kind, moved for each pixel.
        vec2 u = fract(noise + vec2((float(i) + 0.5) / float(RAYS), float(i) * GOLDEN));
        vec3 l = reflect(-v, visible_facet(v, a, u));
        float weight = unmasked(l.z, v.z, a);
        total += weight;
        if (weight <= 0.0) continue;
        Hit found = meet(s.position, axes * l);
        hit.z += float(found.looks);
        if (i == 0 && found.there) hit.xyw = vec3(found.place, 1.0);
        if (!found.there) continue;
        met += weight;
        sum += weight * texelFetch(final, min(ivec2(found.place), ivec2(size.xy) - 1), SAMPLE).rgb;
    }
    float share = total > 0.0 ? met / total : 0.0;
    reflected = vec4((total > 0.0 ? sum / total : vec3(0.0)) + (1.0 - share) * seen_around(s), share);
}
