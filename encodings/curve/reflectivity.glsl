// What a metalness reflects of white, beside reflectivity.py.

float reflectivity_encode_curve(float x, float range) {
    // e = d + (1 - d) x / range
    return REFLECTIVITY_LEAST + (1.0 - REFLECTIVITY_LEAST) * (x / range);
}

float reflectivity_decode_curve(float e, float range) {
    // x = (e - d) / (1 - d) range
    return max((e - REFLECTIVITY_LEAST) / (1.0 - REFLECTIVITY_LEAST) * range, 0.0);
}
