#version 430
// Reads the render target under test back into normals, and the numbers its texels stand for.
#include "code.glsl"
#include "storage.glsl"

uniform sampler2D texels;
uniform sampler2D signed_depths;
uniform sampler2D views;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 stored;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    stored = from_texel(texelFetch(texels, pixel, 0));
#if SIGN_BITS
    // The sign bit, and not a comparison: a depth of zero has a sign too.
    stored[COMPONENTS] = sign_bit(texelFetch(signed_depths, pixel, 0).x) ? -1.0 : 1.0;
#endif
    normal = vec4(DECODE(CODE(stored), texelFetch(views, pixel, 0).xyz), 0.0);
}
