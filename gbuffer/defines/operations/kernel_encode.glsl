// A normal and its view-space position to a code; of an encoding that is rounded precisely to the nearest of the codes
// around, in channels of KERNEL_SCALE steps.
#include "code.glsl"

MADE kernel_operation(GIVEN given, BESIDE beside) {
    return encoded(given, beside, float[](KERNEL_SCALE, KERNEL_SCALE, KERNEL_SCALE), true);
}
