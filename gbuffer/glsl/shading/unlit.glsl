// What a surface shows without lights: light from everywhere, and its own.
#include "surface.glsl"
#if METAL_ROUGH
#include "metal_rough.glsl"
#include "environment.glsl"
#else
#include "frame.glsl"
#endif

// `arriving` is the share of what comes from afar, `added` what other surfaces send, irradiance over pi.
vec3 unlit(Surface s, float arriving, vec3 added) {
    arriving *= s.occlusion;
#if METAL_ROUGH
    mat3 axes = mat3(view_to_world);
    vec3 v = unit(-s.position), mirrored = axes * reflect(-v, s.direction);
    vec3 along = arriving * radiance(mirrored, s.roughness), even = arriving * irradiance(axes * s.direction) + added;
    return answer_to_all(s, v, along, even) + s.emissive;
#else
    return (arriving * ambient.rgb + added) * s.albedo + s.emissive;
#endif
}
