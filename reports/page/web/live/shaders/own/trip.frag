// A normal through an encoder and a storage, whose bits are those of the emulation.
vec3 round_trip(vec3 n, vec3 view) {
    return DECODE(UNPACK(PACK(ENCODE(n, view)), 1.0), view);
}
