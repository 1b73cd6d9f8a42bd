// What 16-bit types lack: the bits of their 32-bit value, for encodings that look at those.
uint half_floatBitsToUint(float16_t x) { return floatBitsToUint(float(x)); }
int half_floatBitsToInt(float16_t x) { return floatBitsToInt(float(x)); }
float16_t half_uintBitsToFloat(uint x) { return float16_t(uintBitsToFloat(x)); }
float16_t half_intBitsToFloat(int x) { return float16_t(intBitsToFloat(x)); }
