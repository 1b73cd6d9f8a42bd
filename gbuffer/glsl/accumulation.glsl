// The light buffer: what light passes add up and later passes read. Of one or two targets: two hold diffuse and
// specular light; one holds the diffuse light, and in its fourth number the luminance of the specular (Drobot).
#include "sample.glsl"
#include "light_code.glsl"
#include "chromaticity.glsl"

#ifdef WRITES_LIGHT
layout(location = 0) out vec4 light_texels[LIGHT_TARGETS];

#if LIGHT_READS
uniform SAMPLER light_before[LIGHT_TARGETS];
#define BEFORE(target) LIGHT_DECODE(texelFetch(light_before[target], ivec2(gl_FragCoord.xy), SAMPLE))
#else
#define BEFORE(target) vec4(0.0)
#endif

void add_light(vec4 first, vec4 second) {
    light_texels[0] = LIGHT_ENCODE(light_or_none(first + BEFORE(0)));
#if LIGHT_TARGETS > 1
    light_texels[1] = LIGHT_ENCODE(light_or_none(second + BEFORE(1)));
#endif
}

// Finished colour, of a pixel that needs no second geometry pass.
void add_colour(vec3 colour) { add_light(vec4(colour, 0.0), vec4(0.0)); }

void add_terms(vec3 diffuse, vec3 specular) {
    bool apart = LIGHT_TARGETS > 1;
    add_light(vec4(diffuse, apart ? 0.0 : luminance(specular)), vec4(specular, 0.0));
}
#else
uniform SAMPLER light_texels[LIGHT_TARGETS];

struct Accumulated {
    vec4 first, second;
};

Accumulated fetch_light(ivec2 pixel) {
    vec4 first = LIGHT_DECODE(texelFetch(light_texels[0], pixel, SAMPLE));
#if LIGHT_TARGETS > 1
    return Accumulated(first, LIGHT_DECODE(texelFetch(light_texels[1], pixel, SAMPLE)));
#else
    return Accumulated(first, vec4(0.0));
#endif
}

// A highlight of the light pass's fixed power at the material's own, [S / sum(N.L att)]^m sum(N.L att), with the sum
// taken for the luminance of the diffuse light (Drobot). A light pass that knows no kinds took it for a general one.
vec3 at_power(vec3 specular, float diffuse, int kind, float power) {
    vec3 per_light = specular / max(diffuse, TINY) / lobe_gain(HAS_KIND != 0 ? kind : GENERAL, LIGHT_PASS_POWER);
    return pow(max(per_light, TINY), vec3(power / LIGHT_PASS_POWER)) * diffuse * lobe_gain(kind, power);
}

// Specular light for a material of this kind and power; `material.glsl` is included before.
vec3 specular_light(Accumulated a, int kind, float power) {
    vec3 diffuse = a.first.rgb;
    vec3 specular = LIGHT_TARGETS > 1 ? a.second.rgb : coloured(diffuse, a.first.a);
    return HAS_POWER != 0 ? specular : at_power(specular, luminance(diffuse), kind, power);
}
#endif
