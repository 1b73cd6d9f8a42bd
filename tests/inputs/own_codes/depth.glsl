float pack_depth(float near, float far, float depth) {
    float d = max(depth, near);
    return (d - near) * far / (d * (far - near));
}
float unpack_depth(float near, float far, float w) { return near * far / (near + (1.0 - w) * (far - near)); }
