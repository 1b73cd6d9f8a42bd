#version 430
// Encodes a texture of normals into the render target under test.
#include "code.glsl"
#include "storage.glsl"
#include "dither.glsl"

uniform sampler2D normals;
uniform sampler2D views;
layout(location = 0) out vec4 texel;
#if SIGN_BITS
layout(location = 1) out float signed_depth;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 view = texelFetch(views, pixel, 0).xyz;
    float scales[] = float[](storage_scale[0], storage_scale[1], storage_scale[2]);
    vec3 n = direction_or_forward(texelFetch(normals, pixel, 0).xyz);
    vec4 code = dithered(widen(encoded(n, view, scales, STORAGE_BIASED != 0)));
#if SIGN_BITS
    signed_depth = abs(view.z) * code[COMPONENTS];
    code[COMPONENTS] = 0.0;
#endif
    texel = to_texel(code);
}
