#version 430
// Puts quantities on a curve, into the render target under test. A curve's number is a texel's, whatever its format.
#include "vec.glsl"
#include "storage.glsl"
#include CURVE_ENCODING

uniform sampler2D quantities;
uniform float range;
layout(location = 0) out vec4 texel;

void main() {
    vec4 number = vec4(CURVE_ENCODE(texelFetch(quantities, ivec2(gl_FragCoord.xy), 0).x, range), 0.0, 0.0, 0.0);
    texel = SHADER_ROUNDS != 0 ? round_texel(number) : number;
}
