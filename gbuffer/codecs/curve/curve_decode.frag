#version 430
// Reads the render target under test back into quantities.
#include "vec.glsl"
#include "storage.glsl"
#include CURVE_ENCODING

uniform sampler2D texels;
uniform float range;
layout(location = 0) out vec4 quantity;

void main() {
    float number = from_texel(texelFetch(texels, ivec2(gl_FragCoord.xy), 0)).x;
    quantity = vec4(CURVE_DECODE(number, range), 0.0, 0.0, 0.0);
}
