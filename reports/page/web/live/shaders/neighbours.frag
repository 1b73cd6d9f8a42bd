// What texels decode to, as the bits of floats.
uniform highp usampler2D texels;
uniform vec3 view;
uniform float sign_of_all;

out uvec4 found;

void main() {
    uvec4 words = texelFetch(texels, ivec2(gl_FragCoord.xy), 0);
    found = uvec4(floatBitsToUint(DECODE(UNPACK(words, sign_of_all), view)), 0u);
}
