/* The six functions of a file, on rows of four numbers for each normal: normal, view and a texel. */
#include <stddef.h>
#include <stdint.h>
#include "code.h"

#if RUN_SIZE == 1
#define RUN_ROW(made, v) ((made)[0] = (v))
#elif RUN_SIZE == 2
#define RUN_LAST code.y
#define RUN_ROW(made, v) ((made)[0] = (v).x, (made)[1] = (v).y)
#elif RUN_SIZE == 3
#define RUN_LAST code.z
#define RUN_ROW(made, v) ((made)[0] = (v).x, (made)[1] = (v).y, (made)[2] = (v).z)
#else
#define RUN_LAST code.w
#define RUN_ROW(made, v) ((made)[0] = (v).x, (made)[1] = (v).y, (made)[2] = (v).z, (made)[3] = (v).w)
#endif
#if RUN_SIGN
#define RUN_WITH_SIGN , RUN_LAST
#else
#define RUN_WITH_SIGN
#endif
#if RUN_WORDS == 1
#define RUN_SET(made, v) ((made)[0] = (v))
#elif RUN_WORDS == 2
#define RUN_SET(made, v) ((made)[0] = (v).x, (made)[1] = (v).y)
#else
#define RUN_SET(made, v) ((made)[0] = (v).x, (made)[1] = (v).y, (made)[2] = (v).z, (made)[3] = (v).w)
#endif

void run_six(size_t count, const float *given, float *made, uint32_t *words);

void run_six(size_t count, const float *given, float *made, uint32_t *words) {
    for (size_t i = 0; i < count; ++i, given += 12, made += 24, words += 4) {
        RUN_VEC4 n = {given[0], given[1], given[2], given[3]}, view = {given[4], given[5], given[6], 0.0f};
        RUN_VEC4 texel = {given[8], given[9], given[10], given[11]};
        RUN_CODE code = RUN_ENCODE(RUN_VALUE);
        RUN_TEXEL packed = RUN_PACK(code);
        RUN_CODE unpacked = RUN_UNPACK(packed RUN_WITH_SIGN);
        RUN_KIND decoded = RUN_DECODE(unpacked RUN_SETTINGS);
        RUN_VEC4 target = RUN_TO_TARGET(code);
        RUN_CODE back = RUN_FROM_TARGET(texel RUN_WITH_SIGN);
        (void)view;
        RUN_ROW(made, code);
        RUN_ROW(made + 4, unpacked);
        const float rows[] = {RUN_FIRST, RUN_SECOND};
        for (int at = 0; at < 4; ++at) made[8 + at] = rows[at], made[20 + at] = rows[4 + at];
        made[12] = target.x, made[13] = target.y, made[14] = target.z, made[15] = target.w;
        RUN_ROW(made + 16, back);
        RUN_SET(words, packed);
    }
}
