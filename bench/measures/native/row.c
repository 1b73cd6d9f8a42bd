// The figures of a row over chunks of normals. Python writes what comes before: `errors_of`, of one normal and its
// decode; BINS, of the histogram; BLOCK, how many normals are measured at once, so that what is computed of them stays in
// the first-level cache.

// Lanes are summed apart, in registers.
#define LANES 16

typedef void Decode(const float *const *plane, const double *given, size_t first, float (*decoded)[BLOCK]);

// What decodes, and what it is given.
typedef struct {
    Decode *decode;
    const double *given;
} Codec;

// Planes of normals and of view positions, and which of them count; `count` is a multiple of BLOCK. `tops` has the
// largest angle of each block once the chunk is measured.
typedef struct {
    const float *plane[6];
    const _Bool *covered;
    float *tops;
    size_t count;
} Chunk;

typedef struct {
    float squared[BLOCK], article[BLOCK], angle[BLOCK];
    int32_t invalid[BLOCK], bin[BLOCK];
} Block;

static _Bool is_covered(const Chunk *chunk, size_t first) { return !memchr(chunk->covered + first, 0, BLOCK); }

static void measure(const Codec *codec, const Chunk *chunk, size_t first, float (*decoded)[BLOCK], Block *block) {
    const float *const *n = chunk->plane;
    codec->decode(n, codec->given, first, decoded);
    for (size_t k = 0; k < BLOCK; k++) {
        size_t i = first + k;
        errors_of(n[0][i], n[1][i], n[2][i], decoded[0][k], decoded[1][k], decoded[2][k], &block->squared[k],
            &block->article[k], &block->angle[k], &block->invalid[k], &block->bin[k]);
    }
    if (is_covered(chunk, first)) return;
    for (size_t k = 0; k < BLOCK; k++)
        if (!chunk->covered[first + k]) {
            block->squared[k] = block->article[k] = block->angle[k] = 0;
            block->invalid[k] = 0;
            block->bin[k] = BINS;
        }
}

static double summed(const float *a) {
    double lanes[LANES] = {0}, sum = 0;
    for (size_t k = 0; k < BLOCK; k += LANES)
        for (size_t l = 0; l < LANES; l++) lanes[l] += a[k + l];
    for (size_t l = 0; l < LANES; l++) sum += lanes[l];
    return sum;
}

// The squares are rounded to float before they are added, as XLA's are.
static double summed_squares(const float *a) {
    double lanes[LANES] = {0}, sum = 0;
    for (size_t k = 0; k < BLOCK; k += LANES)
        for (size_t l = 0; l < LANES; l++) lanes[l] += a[k + l] * a[k + l];
    for (size_t l = 0; l < LANES; l++) sum += lanes[l];
    return sum;
}

// Of numbers that are not negative, whose bits are in the same order. Integers may be compared in any order.
static float largest(const float *a) {
    uint32_t top = 0;
    for (size_t k = 0; k < BLOCK; k++) {
        uint32_t bits = VIEWED(float, uint32_t, a[k]);
        top = bits > top ? bits : top;
    }
    return VIEWED(uint32_t, float, top);
}

// Has the memory fetch the normals of the next block while this one is computed: a line of the cache holds 16 numbers.
static void fetch_next(const Chunk *chunk, size_t first) {
    if (first + BLOCK == chunk->count) return;
    for (int c = 0; c < 3; c++)
        for (size_t k = first + BLOCK; k < first + 2 * BLOCK; k += 16) __builtin_prefetch(chunk->plane[c] + k);
}

// Adds to `figures`, in the order of Python's `Figures`, and to `counts`, those of the bins.
void row(const Codec *codec, const Chunk *chunk, double *figures, uint32_t *counts) {
    unsigned was = flush();
    Block block;
    float decoded[3][BLOCK];
    for (size_t first = 0; first < chunk->count; first += BLOCK) {
        int32_t article = 0, invalid = 0;
        fetch_next(chunk, first);
        measure(codec, chunk, first, decoded, &block);
        for (size_t k = 0; k < BLOCK; k++) {
            article += (int32_t)block.article[k];
            invalid += block.invalid[k];
        }
        float top = largest(block.angle);
        figures[0] += summed(block.squared);
        figures[1] += article;
        figures[2] += summed(block.angle);
        figures[3] += summed_squares(block.angle);
        figures[4] += invalid;
        figures[5] = top > figures[5] ? top : figures[5];
        chunk->tops[first / BLOCK] = top;
        for (size_t k = 0; k < BLOCK; k++) counts[block.bin[k]]++;
    }
    set_back(was);
}

// The normals of a bin among blocks whose largest angle is `least` or more: six numbers each into `found`, the normal
// and its decode, `room` at most. Of those that are decoded as they were only the first is there. Returns how many.
size_t in_bin(const Codec *codec, const Chunk *chunk, float least, int bin, size_t room, float *found) {
    unsigned was = flush();
    Block block;
    float decoded[3][BLOCK];
    size_t have = 0;
    _Bool has_same = 0;
    for (size_t first = 0; first < chunk->count; first += BLOCK) {
        if (chunk->tops[first / BLOCK] < least) continue;
        measure(codec, chunk, first, decoded, &block);
        for (size_t k = 0; k < BLOCK; k++) {
            if (block.bin[k] != bin || have == room) continue;
            float *to = found + 6 * have;
            for (int c = 0; c < 3; c++) to[c] = chunk->plane[c][first + k], to[3 + c] = decoded[c][k];
            _Bool is_same = to[0] == to[3] && to[1] == to[4] && to[2] == to[5];
            if (is_same && has_same) continue;
            has_same |= is_same;
            have++;
        }
    }
    set_back(was);
    return have;
}
