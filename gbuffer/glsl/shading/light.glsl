// Lights and what of them arrives at a point.
#include "vec.glsl"

struct Light {
    vec4 position_radius;   // view space
    vec4 colour_kind;
    vec4 direction_outer;   // view space, the way the light goes; the cosine of the outer half angle
    vec4 inner;             // the cosine of the inner half angle
};
layout(std430, binding = 2) readonly buffer Lights { Light lights[]; };

#if SHADOWS
uniform sampler2D shadow_map;

// The share of the sun that arrives: nine texels of the shadow map, compared one by one (percentage closer filtering).
float sunlight(vec3 position) {
    vec4 p = view_to_sun * vec4(position, 1.0);
    ivec2 texel = ivec2(floor(p.xy * size.z)), last = ivec2(size.z) - 1;
    float depth = min(p.z, 1.0), seen = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 at = texel + ivec2(x, y);
            bool outside = any(lessThan(at, ivec2(0))) || any(greaterThan(at, last));
            seen += outside || depth <= texelFetch(shadow_map, clamp(at, ivec2(0), last), 0).x ? 1.0 : 0.0;
        }
    return seen / 9.0;
}
#else
float sunlight(vec3 position) { return 1.0; }
#endif

// Light of unit colour at a distance, zero at the radius (Karis 2013): (1 - (d/r)^4)^2 / (d^2 + 1)
float falloff(float distance2, float radius) {
    float t = distance2 / (radius * radius), window = max(1.0 - t * t, 0.0);
    return window * window / (distance2 + 1.0);
}

// What arrives at `position`, and from where: l points to the light. A sun is the first of the lights.
vec3 from_sun(vec3 position, out vec3 l) {
    l = -lights[0].direction_outer.xyz;
    return lights[0].colour_kind.rgb * sunlight(position);
}

vec3 from_lamp(Light light, vec3 position, out vec3 l) {
    vec3 way = light.position_radius.xyz - position;
    l = unit(way);
    float share = falloff(dot(way, way), light.position_radius.w);
    float cone = smoothstep(light.direction_outer.w, light.inner.x, -dot(l, light.direction_outer.xyz));
    return light.colour_kind.rgb * (int(light.colour_kind.w) == SPOT ? share * cone : share);
}
