// A chunk of normals that are computed from their numbers. Python writes what comes before: `made`, one normal; GIVEN,
// what that takes of the array `given`.

void fill(uint32_t count, const double *given, float *x, float *y, float *z) {
    for (uint32_t lane = 0; lane < count; lane++) made(lane GIVEN, x + lane, y + lane, z + lane);
}
