// Sunlight that comes through thin parts from behind (Jimenez, Whelan, Sundstedt and Gutierrez 2010, Real-Time Realistic
// Skin Translucency; constants of SeparableSSS.h).
#include "light.glsl"

uniform sampler2D sun_entry;  // depth of what the sun reaches first

const float variances[] = VARIANCES;
const float weights[] = WEIGHTS;  // of red, green and blue, for each variance

// T(d) = sum of w exp(-d^2 / v), which is 1 for d = 0
vec3 transmittance(float d) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < PROFILE_GAUSSIANS; ++i)
        sum += vec3(weights[3 * i], weights[3 * i + 1], weights[3 * i + 2]) * exp(-d * d / variances[i]);
    return sum;
}

vec3 transmitted_sunlight(Surface s) {
    // From a little inside, so that no lit side is behind itself.
    vec4 p = view_to_sun * vec4(s.position - SHRINK * s.direction, 1.0);
    ivec2 texel = clamp(ivec2(floor(p.xy * size.z)), ivec2(0), ivec2(size.z) - 1);
    float per_metre = length(vec3(view_to_sun[0].z, view_to_sun[1].z, view_to_sun[2].z));
    float metres = abs(p.z - texelFetch(sun_entry, texel, 0).x) / per_metre;
    // Light that arrives at the far side, wrapped around: saturate(0.3 + L.(-n))
    float arrives = clamp(BACK_WRAP + dot(lights[0].direction_outer.xyz, s.direction), 0.0, 1.0);
    return lights[0].colour_kind.rgb * transmittance(THICKNESS_SCALE * metres) * arrives;
}
