// What comparisons and limits make of NaN, which `given` holds.
precision highp float;
precision highp sampler2D;
uniform sampler2D given;
out uvec4 bits;

void main() {
    float nan = texelFetch(given, ivec2(0), 0).x;
    uint seen = (isnan(nan) ? 1u : 0u) | (nan != nan ? 2u : 0u);
    bits = uvec4(floatBitsToUint(min(nan, 1.0)), floatBitsToUint(max(nan, 0.0)), floatBitsToUint(clamp(nan, 0.0, 1.0)), seen);
}
