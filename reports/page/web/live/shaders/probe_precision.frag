// The bits of a number's mantissa: how often a step can be halved before 1 plus the step is 1.
precision PRECISION float;
precision highp int;
uniform float one;
layout(location = 0) out highp uvec4 bits;

void main() {
    float step = one;
    uint count = 0u;
    for (int k = 1; k <= 40; ++k) {
        step *= 0.5;
        float sum = one + step;
        if (sum - one > 0.0) count = uint(k);
    }
    bits = uvec4(count, 0u, 0u, 0u);
}
