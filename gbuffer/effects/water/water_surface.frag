#version 430
// The colour of water: what it mirrors, what is seen through it, its own dark colour, light in its crests, the sun.
#include "sample.glsl"
#include "light.glsl"
#include "material.glsl"
#include "water_map.glsl"
#include "water_optics.glsl"
#include "water_seen.glsl"

in vec2 rest;
uniform vec3 deep;
uniform vec3 crests;
uniform float deviation;                   // of the height, in metres
uniform float slopes[LEVELS + 1];  // mean squares, by level
layout(location = 0) out vec4 water;

// The mean square slope of waves that are too short to be seen in a pixel.
float lost_slope(float spacing) {
    float at = level_for(spacing), whole = floor(at);
    int next = min(int(whole) + 1, LEVELS);
    return slopes[0] - mix(slopes[int(whole)], slopes[next], at - whole);
}

// Light that crests let through from behind, after Island 11 (NVIDIA 2011); heights count in standard deviations.
float crest_light(float height, vec3 v, vec3 l, vec3 n, vec3 up) {
    float crest = deviation > 0.0 ? max(CREST_HEIGHT * (height / deviation + 1.0), 0.0) : 0.0;
    float behind_it = max(-dot(v, unit(l - up * dot(l, up))), 0.0);
    return CREST_GAIN * crest * behind_it * behind_it * pow(max(1.0 - dot(l, n), 0.0), CREST_POWER);
}

void main() {
    // Two points a wave are as many as pixels can show.
    float spacing = max(length(dFdx(rest)), length(dFdy(rest))) * 2.0 / POINTS_A_WAVE;
    Wave wave = wave_at(rest, spacing);
    float lost = lost_slope(spacing);
    vec3 up = vec3(0.0, 1.0, 0.0) * mat3(view_to_world), n = wave_normal(wave) * mat3(view_to_world);
    vec3 v = unit(-position), own = vec3(0.0), glitter = vec3(0.0), light = ambient.rgb, sun_share = vec3(0.0), l;
#if LIT_BY_SUN
    vec3 h, sunny = from_sun(position, l);
    h = unit(l + v);
    light += sunny * max(dot(l, up), 0.0);
    sun_share = sunny * max(dot(l, up), 0.0) / max(light, TINY);
    own = crests * sunny * crest_light(wave.height, v, l, n, up);
    // 1 / power is about the mean square slope, along each axis, of facets in a Blinn-Phong lobe: waves that are too
    // short to be seen add theirs.
    float power = SUN_POWER / (1.0 + 0.5 * SUN_POWER * lost);
    glitter = sunny * water_fresnel(dot(v, h)) * lobe(dot(n, h), power) * max(dot(n, l), 0.0);
#endif
    float share = water_fresnel(dot(n, v));
    vec3 through = refracted(n, up, deep * light, sun_share) + own;
    water = vec4(mix(through, mirrored(n, up, lost), share) + glitter, 1.0);
}
