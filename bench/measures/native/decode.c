// Normals through a codec. Python writes what comes before: `round_trip`, one normal; GIVEN, what that takes
// of the array `given` behind the normal and the view position; BLOCK, how many normals there are.

void decode(const float *const *plane, const double *given, size_t first, float (*decoded)[BLOCK]) {
    for (size_t k = 0; k < BLOCK; k++) {
        size_t i = first + k;
        round_trip(plane[0][i], plane[1][i], plane[2][i], plane[3][i], plane[4][i], plane[5][i] GIVEN, &decoded[0][k],
            &decoded[1][k], &decoded[2][k]);
    }
}

// Normals, a multiple of BLOCK, into three planes.
void decode_all(const float *const *plane, const double *given, size_t count, float *const *decoded) {
    unsigned was = flush();
    float block[3][BLOCK];
    for (size_t first = 0; first < count; first += BLOCK) {
        decode(plane, given, first, block);
        for (int c = 0; c < 3; c++) memcpy(decoded[c] + first, block[c], sizeof block[c]);
    }
    set_back(was);
}
