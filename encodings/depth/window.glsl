// z/w of the usual projection, beside window.py.

float window_encode_depth(float depth, float near, float far) {
    // w = (d - near) far / (d (far - near))
    float d = max(depth, near);
    return (d - near) * far / (d * (far - near));
}

float window_decode_depth(float number, float near, float far) {
    // d = near far / (near + (1 - w) (far - near))
    return near * far / (near + (1.0 - number) * (far - near));
}
