// What stands above all C that this program compiles for itself.
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <tgmath.h>

// GCC would follow a number that is limited from above and below on each of its ways, and what is computed of it twice.
// Clang has no such option, and passes over the line.
#pragma GCC optimize ("no-thread-jumps")

// Inlined into whatever calls it: by itself the compiler does so up to a size, and loops with calls are slow.
#define INLINED __attribute__((always_inline)) static inline

// The bits of a number as a number of another type.
#define VIEWED(source, target, value) \
    ({ source from_ = (value); target to_; memcpy(&to_, &from_, sizeof to_); to_; })

// Numbers below the normal ones are 0, as for JAX and on GPUs; returns how the processor was set before.
static unsigned flush(void) {
#ifdef __SSE__
    unsigned was = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(was | 0x8040);
    return was;
#else
    return 0;
#endif
}

static void set_back(unsigned was) {
#ifdef __SSE__
    __builtin_ia32_ldmxcsr(was);
#endif
}

// 0, which the compiler does not know. GCC makes one rounding of a conversion to an integer and back, which keeps the
// sign of -0.3 where the integer 0 has none.
int32_t NOTHING;
