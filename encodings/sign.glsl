// Sign bits, beside vec.py.

// Whether the sign bit is set: of negative numbers and of -0.
bool sign_bit(float x) { return floatBitsToUint(x) >> 31 != 0u; }

// x, which is not negative, under the sign bit of another number; not -x, which a compiler may take for 0 - x.
float with_sign_of(float x, float signed_number) {
    return sign_bit(signed_number) ? uintBitsToFloat(floatBitsToUint(x) ^ (1u << 31)) : x;
}
