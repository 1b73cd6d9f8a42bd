// The row in C: what the throughput is held against. Encode, UNORM8, decode, and the statistics of the angle (mean, RMS,
// maximum, and a histogram of bins of 2^15 units in the last place).
//
// cc -O3 -march=native -ffast-math -fopenmp -DENCODING=spheremap -DVIEW=0
//
// Blocks of a thread: what is computed of them stays in its first-level cache.

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 1024
#define BINS (1 << 17)
#define BIN_SHIFT 15
#define DEGREES 57.29577951308232f

typedef struct { float x, y, z; } Vec;

static inline float store(float c) {
    float x = fminf(fmaxf(c * 0.5f + 0.5f, 0.0f), 1.0f);
    return rintf(x * 255.0f) * (2.0f / 255.0f) - 1.0f;
}

// atan(t) for t in [0, 1], odd polynomial; Abramowitz and Stegun 4.4.49, absolute error below 2e-8.
static inline float arc(float t) {
    float s = t * t;
    float p = 0.0028662257f;
    p = p * s - 0.0161657367f;
    p = p * s + 0.0429096138f;
    p = p * s - 0.0752896400f;
    p = p * s + 0.1065626393f;
    p = p * s - 0.1420889944f;
    p = p * s + 0.1999355085f;
    p = p * s - 0.3333314528f;
    return t + t * s * p;
}

static inline float angle(float y, float x) {
    float a = fabsf(x), b = fabsf(y), low = fminf(a, b), high = fmaxf(a, b);
    float r = arc(low / fmaxf(high, 1e-30f));
    r = b > a ? 1.57079632679f - r : r;
    r = x < 0 ? 3.14159265359f - r : r;
    return y < 0 ? -r : r;
}

static inline Vec xyz(Vec n, Vec v) { return (Vec){store(n.x), store(n.y), store(n.z)}; }

static inline Vec spheremap(Vec n, Vec v) {
    float f = 2.0f / sqrtf(8.0f * n.z + 8.0f);
    float x = 2.0f * store(n.z > -1.0f ? n.x * f : 1.0f), y = 2.0f * store(n.z > -1.0f ? n.y * f : 0.0f);
    float q = fminf(x * x + y * y, 4.0f), g = sqrtf(1.0f - q / 4.0f);
    return (Vec){x * g, y * g, 1.0f - q / 2.0f};
}

static inline Vec octahedral(Vec n, Vec v) {
    float s = 1.0f / (fabsf(n.x) + fabsf(n.y) + fabsf(n.z)), x = n.x * s, y = n.y * s;
    float u = n.z < 0 ? (1.0f - fabsf(y)) * (x < 0 ? -1.0f : 1.0f) : x;
    float w = n.z < 0 ? (1.0f - fabsf(x)) * (y < 0 ? -1.0f : 1.0f) : y;
    u = store(u), w = store(w);
    float z = 1.0f - fabsf(u) - fabsf(w), t = fmaxf(-z, 0.0f);
    u -= u < 0 ? -t : t, w -= w < 0 ? -t : t;
    float r = 1.0f / sqrtf(u * u + w * w + z * z);
    return (Vec){u * r, w * r, z * r};
}

// sin and cos of pi a, a in [-1, 1]: Taylor series about the nearest quarter turn.
static inline Vec spherical(Vec n, Vec v) {
    float a = store(angle(n.y, n.x) * 0.318309886f), z = store(n.z), r = sqrtf(fmaxf(1.0f - z * z, 0.0f));
    float q = floorf(2.0f * a + 0.5f), t = 3.14159265359f * (a - 0.5f * q), s = t * t;
    float sine = t * (1.0f + s * (-1.0f / 6 + s * (1.0f / 120 + s * (-1.0f / 5040))));
    float cosine = 1.0f + s * (-0.5f + s * (1.0f / 24 + s * (-1.0f / 720 + s * (1.0f / 40320))));
    int k = (int)q & 3;
    float c = k & 1 ? sine : cosine, d = k & 1 ? cosine : sine;
    c = k == 1 || k == 2 ? -c : c, d = k & 2 ? -d : d;
    return (Vec){c * r, d * r, z};
}

static inline Vec per_pixel_view(Vec n, Vec v) {
    float l = -1.0f / sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    Vec z = {v.x * l, v.y * l, v.z * l};
    float m = 1.0f / sqrtf(z.z * z.z + z.x * z.x);
    Vec x = {z.z * m, 0.0f, -z.x * m};
    Vec y = {z.y * x.z, z.z * x.x - z.x * x.z, -z.y * x.x};
    float a = store(x.x * n.x + x.z * n.z), b = store(y.x * n.x + y.y * n.y + y.z * n.z);
    float h = sqrtf(fmaxf(1.0f - a * a - b * b, 0.0f));
    return (Vec){x.x * a + y.x * b + z.x * h, y.y * b + z.y * h, x.z * a + y.z * b + z.z * h};
}

static inline Vec at(const float *const *plane, long i) { return (Vec){plane[0][i], plane[1][i], plane[2][i]}; }

#if VIEW
#define SEEN at(view, i)
#else
#define SEEN ((Vec){0, 0, -1})
#endif

// Sum of all components, into figures[0]: the normals are read, and nothing else is done.
void reading(const float *const *n, const float *const *view, long count, double *figures) {
    double total = 0;
#pragma omp parallel for reduction(+ : total) schedule(static)
    for (long first = 0; first < count; first += BLOCK) {
        float sum = 0;
        long end = first + BLOCK < count ? first + BLOCK : count;
        for (long i = first; i < end; i++) sum += n[0][i] + n[1][i] + n[2][i];
        total += sum;
    }
    figures[0] = total;
}

// Sum of angles and of their squares and the largest, in degrees, into figures; counts[BINS] of their bins.
void row(const float *const *n, const float *const *view, long count, double *figures, int64_t *counts) {
    double total = 0, squares = 0;
    float largest = 0;
    memset(counts, 0, BINS * sizeof *counts);
#pragma omp parallel reduction(+ : total, squares) reduction(max : largest)
    {
        uint32_t *own = calloc(BINS, sizeof *own), key[BLOCK];
#pragma omp for schedule(static)
        for (long first = 0; first < count; first += BLOCK) {
            float sum = 0, square = 0, top = 0;
            long size = first + BLOCK < count ? BLOCK : count - first;
            for (long k = 0; k < size; k++) {
                long i = first + k;
                Vec a = at(n, i), d = ENCODING(a, SEEN), e = {d.x - a.x, d.y - a.y, d.z - a.z};
                float x = a.y * e.z - a.z * e.y, y = a.z * e.x - a.x * e.z, z = a.x * e.y - a.y * e.x;
                float g = DEGREES * angle(sqrtf(x * x + y * y + z * z), a.x * d.x + a.y * d.y + a.z * d.z);
                uint32_t bits;
                memcpy(&bits, &g, sizeof bits);
                key[k] = bits >> BIN_SHIFT;
                sum += g, square += g * g;
                top = fmaxf(top, g);
            }
            for (long k = 0; k < size; k++) own[key[k] & (BINS - 1)]++;
            total += sum, squares += square;
            largest = fmaxf(largest, top);
        }
#pragma omp critical
        for (long b = 0; b < BINS; b++) counts[b] += own[b];
        free(own);
    }
    figures[0] = total, figures[1] = squares, figures[2] = largest;
}
