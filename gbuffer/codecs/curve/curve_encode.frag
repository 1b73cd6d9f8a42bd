#version 430
// Puts quantities on a curve, into the render target under test.
#include "vec.glsl"
#include "storage.glsl"
#include CURVE_ENCODING

uniform sampler2D quantities;  // and what is added to their numbers
uniform float range;
layout(location = 0) out vec4 texel;

void main() {
    vec2 quantity = texelFetch(quantities, ivec2(gl_FragCoord.xy), 0).xy;
    texel = to_texel(vec4(CURVE_ENCODE(quantity.x, range) + quantity.y, 0.0, 0.0, 0.0));
}
