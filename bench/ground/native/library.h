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
