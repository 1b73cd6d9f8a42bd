#version 430
// Encodes each sample of a pixel: one normal in the first `counts` of them, another in the others.
#include "sample.glsl"
#include "mix.glsl"

uniform sampler2D normals;
uniform sampler2D others;
uniform sampler2D counts;
uniform sampler2D views;
layout(location = 0) out vec4 texel;
#if SIGN_BITS
layout(location = 1) out float signed_depth;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 view = texelFetch(views, pixel, 0).xyz;
    bool is_first = float(SAMPLE) < texelFetch(counts, pixel, 0).x;
    vec3 n = is_first ? texelFetch(normals, pixel, 0).xyz : texelFetch(others, pixel, 0).xyz;
    float scales[] = float[](storage_scale[0], storage_scale[1], storage_scale[2]);
    vec4 code = widen(encoded(direction_or_forward(n), view, scales, STORAGE_BIASED != 0));
#if SIGN_BITS
    signed_depth = abs(view.z) * code[COMPONENTS];
    code[COMPONENTS] = 0.0;
#endif
    texel = to_texel(code);
}
