// The light buffer: what light passes add up and later passes read. Of one or two targets: two hold diffuse and
// specular light; one holds the diffuse light, and in its alpha the luminance of the specular (seed 002). A format that
// ends at 1 keeps light divided by LIGHT_RANGE.
#include "sample.glsl"

float luminance(vec3 c) {
    const float luma[] = LUMA;
    return dot(c, vec3(luma[0], luma[1], luma[2]));
}

// The colour of light, at luminance 1; white where there is none.
vec3 chromaticity(vec3 c) {
    float l = luminance(c);
    return l > TINY ? c / l : vec3(1.0);
}

#ifdef WRITES_LIGHT
layout(location = 0) out vec4 light_texels[LIGHT_TARGETS];

// Finished colour, of a pixel that needs no second geometry pass.
void add_colour(vec3 colour) {
    light_texels[0] = vec4(colour / LIGHT_RANGE, 0.0);
#if LIGHT_TARGETS > 1
    light_texels[1] = vec4(0.0);
#endif
}

void add_light(vec3 diffuse, vec3 specular) {
#if LIGHT_TARGETS > 1
    light_texels[0] = vec4(diffuse / LIGHT_RANGE, 0.0);
    light_texels[1] = vec4(specular / LIGHT_RANGE, 0.0);
#else
    light_texels[0] = vec4(diffuse, luminance(specular)) / LIGHT_RANGE;
#endif
}
#else
uniform SAMPLER light_texels[LIGHT_TARGETS];

struct Accumulated {
    vec4 first, second;
};

Accumulated fetch_light(ivec2 pixel) {
    vec4 first = texelFetch(light_texels[0], pixel, SAMPLE) * LIGHT_RANGE;
#if LIGHT_TARGETS > 1
    return Accumulated(first, texelFetch(light_texels[1], pixel, SAMPLE) * LIGHT_RANGE);
#else
    return Accumulated(first, vec4(0.0));
#endif
}

// A highlight of the light pass's fixed power at the material's own, [S / sum(N.L att)]^m sum(N.L att), with the sum
// taken for the luminance of the diffuse light (seed 002). A light pass that knows no kinds took it for a general one.
vec3 at_power(vec3 specular, float diffuse, int kind, float power) {
    vec3 per_light = specular / max(diffuse, TINY) / lobe_gain(HAS_KIND != 0 ? kind : GENERAL, LIGHT_PASS_POWER);
    return pow(max(per_light, TINY), vec3(power / LIGHT_PASS_POWER)) * diffuse * lobe_gain(kind, power);
}

// Specular light for a material of this kind and power; `material.glsl` is included before.
vec3 specular_light(Accumulated a, int kind, float power) {
    vec3 diffuse = a.first.rgb;
    vec3 specular = LIGHT_TARGETS > 1 ? a.second.rgb : chromaticity(diffuse) * a.first.a;
    return HAS_POWER != 0 ? specular : at_power(specular, luminance(diffuse), kind, power);
}
#endif
