// Linear depth with the sign of the normal's z, beside linear_sign.py.
#include "../vec.glsl"

float linear_sign_encode_depth(float depth, float near, float far) {
    // l = sign |d| / far
    return with_sign_of(abs(depth) / far, depth);
}

float linear_sign_decode_depth(float number, float near, float far) {
    // d = sign |l| far
    return with_sign_of(abs(number) * far, number);
}
