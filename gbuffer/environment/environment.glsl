// What lies around at every distance, as a surface of some roughness sees it: levels of one roughness each, narrow lobes
// in more texels than wide ones. HAS_ENVIRONMENT is 0 where light is the same from everywhere.
#include "frame.glsl"

#if HAS_ENVIRONMENT
uniform sampler2DArray environment_fine, environment_coarse;
const float fine_roughness[] = FINE_ROUGHNESS, coarse_roughness[] = COARSE_ROUGHNESS;

// A level towards a direction in world space; row 0 is up, -z in the middle. Bilinear by hand: a device's own weights
// have eight bits, which would show as steps.
vec3 level(sampler2DArray levels, int index, vec3 direction) {
    ivec2 size = textureSize(levels, 0).xy;
    float from_pole = length(direction.xz);
    // Straight up and down any longitude will do; GLSL has none for them.
    float longitude = from_pole > 0.0 ? atan(direction.x, -direction.z) : 0.0;
    vec2 turn = vec2(longitude / (2.0 * PI) + 0.5, atan(from_pole, direction.y) / PI);
    vec2 place = turn * vec2(size) - 0.5, share = fract(place);
    ivec2 at = ivec2(floor(place)), next = at + 1;
    ivec2 column = ivec2((at.x + size.x) % size.x, next.x % size.x), row = clamp(ivec2(at.y, next.y), 0, size.y - 1);
    vec3 above = mix(texelFetch(levels, ivec3(column.x, row.x, index), 0).rgb,
                     texelFetch(levels, ivec3(column.y, row.x, index), 0).rgb, share.x);
    vec3 below = mix(texelFetch(levels, ivec3(column.x, row.y, index), 0).rgb,
                     texelFetch(levels, ivec3(column.y, row.y, index), 0).rgb, share.x);
    return mix(above, below, share.y);
}

// Radiance around a direction in world space, by the width of a roughness.
vec3 radiance(vec3 direction, float roughness) {
    int i = 0;
    if (roughness < coarse_roughness[0]) {
        while (i < FINE_LEVELS - 2 && roughness >= fine_roughness[i + 1]) ++i;
        float share = (roughness - fine_roughness[i]) / (fine_roughness[i + 1] - fine_roughness[i]);
        vec3 near = level(environment_fine, i, direction);
        return share > 0.0 ? mix(near, level(environment_fine, i + 1, direction), share) : near;
    }
    while (i < COARSE_LEVELS - 2 && roughness >= coarse_roughness[i + 1]) ++i;
    float share = (roughness - coarse_roughness[i]) / (coarse_roughness[i + 1] - coarse_roughness[i]);
    return mix(level(environment_coarse, i, direction), level(environment_coarse, i + 1, direction), min(share, 1.0));
}

// Irradiance over pi of a surface whose normal points there: GGX's lobe of roughness 1 is the cosine.
vec3 irradiance(vec3 direction) { return level(environment_coarse, COARSE_LEVELS - 1, direction); }
#else
vec3 radiance(vec3 direction, float roughness) { return ambient.rgb; }
vec3 irradiance(vec3 direction) { return ambient.rgb; }
#endif
