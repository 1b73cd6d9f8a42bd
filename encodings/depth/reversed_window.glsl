// Reversed z/w, beside reversed_window.py.

float reversed_window_encode_depth(float depth, float near, float far) {
    // r = near (far - d) / (d (far - near))
    float d = max(depth, near);
    return near * (far - d) / (d * (far - near));
}

float reversed_window_decode_depth(float number, float near, float far) {
    // d = near far / (near + r (far - near))
    return near * far / (near + number * (far - near));
}
