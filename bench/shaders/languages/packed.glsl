#ifdef AS_IT_STANDS
// What the two functions cost is counted without a way to halves and back.
vec2 NAME_halves(uint k) {
    return vec2(uintBitsToFloat(k), 0.0);
}

uint NAME_whole(vec2 e) {
    return floatBitsToUint(e.x);
}
#else
vec2 NAME_halves(uint k) {
    // Of 16 bits each, as numbers from -1 to 1: a channel of 16 bits holds them exactly.
    return vec2(float(k & 0xFFFFu), float(k >> 16)) * (2.0 / LARGEST) - 1.0;
}

uint NAME_whole(vec2 e) {
    uint low = uint(floor((e.x * 0.5 + 0.5) * LARGEST + 0.5));
    uint high = uint(floor((e.y * 0.5 + 0.5) * LARGEST + 0.5));
    return low | (high << 16);
}
#endif

vec2 NAME_encode(vec3 n, vec3 view) {
    return NAME_halves(ENCODED);
}

vec3 NAME_decode(vec2 e, vec3 view) {
    return DECODED;
}
