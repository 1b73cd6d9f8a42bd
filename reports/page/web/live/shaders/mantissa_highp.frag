// How many bits of a mantissa highp floats keep: 1 + 2^-k, while that is more than 1.
uniform highp float one;

out highp uvec4 bits;

void main() {
    highp float step = one;
    int k = 0;
    for (int i = 0; i < 32; ++i) {
        step *= 0.5;
        highp float sum = one + step;
        if (sum > one) {
            k = i + 1;
        }
    }
    bits = uvec4(k, 0, 0, 0);
}
