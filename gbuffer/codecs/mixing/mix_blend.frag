#version 430
// Blends two codes as a shader does that reads both: decoded, blended, and encoded again.
#include "mix.glsl"

uniform sampler2D texels;
uniform sampler2D signed_depths;
uniform sampler2D decals;
uniform sampler2D signed_decals;
uniform sampler2D alphas;
uniform sampler2D views;
layout(location = 0) out vec4 texel;
#if SIGN_BITS
layout(location = 1) out float signed_depth;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 view = texelFetch(views, pixel, 0).xyz;
    vec3 base = DECODE(met(texelFetch(texels, pixel, 0), texelFetch(signed_depths, pixel, 0).x), view);
    vec3 decal = DECODE(met(texelFetch(decals, pixel, 0), texelFetch(signed_decals, pixel, 0).x), view);
    vec3 n = unit(mix(unit(base), unit(decal), texelFetch(alphas, pixel, 0).x));
    float scales[] = float[](storage_scale[0], storage_scale[1], storage_scale[2]);
    vec4 code = widen(encoded(n, view, scales, STORAGE_BIASED != 0));
#if SIGN_BITS
    signed_depth = abs(view.z) * code[COMPONENTS];
    code[COMPONENTS] = 0.0;
#endif
    texel = to_texel(code);
}
