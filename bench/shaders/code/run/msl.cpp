// The six functions of a file of Metal, on rows of four numbers for each normal: normal, view and a texel. By clang.
#include "code.metal"

static texture2d<float> RUN_TABLES;
static texture2d<float> *const run_tables[] = {RUN_POINTERS};

extern "C" void run_set_table(size_t at, const float *texels, uint width, uint height) {
    *run_tables[at] = texture2d<float>{texels, width, height};
}

#if RUN_SIGN
#define RUN_WITH_SIGN , code[RUN_SIZE - 1]
#else
#define RUN_WITH_SIGN
#endif

static void run_row(float *made, float v) { made[0] = v; }
template <class V> static void run_row(float *made, V v) {
    for (int i = 0; i < sized<V>::count; ++i) made[i] = v[i];
}
static void run_words(uint *words, uint v) { words[0] = v; }
static void run_words(uint *words, uint2 v) { words[0] = v.x, words[1] = v.y; }
static void run_words(uint *words, uint4 v) { words[0] = v.x, words[1] = v.y, words[2] = v.z, words[3] = v.w; }

extern "C" void run_six(size_t count, const float *given, float *made, uint *words) {
    for (size_t i = 0; i < count; ++i, given += 12, made += 24, words += 4) {
        float4 n = {given[0], given[1], given[2], given[3]}, view = {given[4], given[5], given[6], 0.0f};
        float4 texel = {given[8], given[9], given[10], given[11]};
        auto code = RUN_ENCODE(RUN_VALUE RUN_ENCODE_TABLES);
        auto packed = RUN_PACK(code);
        auto unpacked = RUN_UNPACK(packed RUN_WITH_SIGN);
        (void)view;
        run_row(made, code);
        run_row(made + 4, unpacked);
        auto decoded = RUN_DECODE(unpacked RUN_SETTINGS RUN_DECODE_TABLES);
        run_row(made + 8, float4(RUN_FIRST));
        run_row(made + 12, RUN_TO_TARGET(code));
        run_row(made + 16, RUN_FROM_TARGET(texel RUN_WITH_SIGN));
        run_row(made + 20, float4(RUN_SECOND));
        run_words(words, packed);
    }
}
