// Linear depth, beside linear.py.

float linear_encode_depth(float depth, float near, float far) {
    // l = d / far
    return max(depth, 0.0) / far;
}

float linear_decode_depth(float number, float near, float far) {
    // d = l far
    return number * far;
}
