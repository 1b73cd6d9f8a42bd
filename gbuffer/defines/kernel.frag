#version 450
// One operation between interpolation and export, for a compiler to be asked what it costs. What goes in is written
// again, so that no input is dropped for want of a use; numbers are moved one by one, as the compute kernel does it, so
// that SPIR-V takes vectors apart and together in the operation alone.
#include OPERATION

layout(location = 0) in GIVEN kernel_given;
layout(location = 1) in BESIDE kernel_beside;
layout(location = 0) out MADE kernel_made;
layout(location = 1) out GIVEN kernel_kept_given;
layout(location = 2) out BESIDE kernel_kept_beside;

void main() {
    GIVEN given;
    BESIDE beside;
    for (int i = 0; i < given.length(); ++i) given[i] = kernel_given[i];
    for (int i = 0; i < beside.length(); ++i) beside[i] = kernel_beside[i];
    MADE made = kernel_operation(given, beside);
    for (int i = 0; i < made.length(); ++i) kernel_made[i] = made[i];
    for (int i = 0; i < given.length(); ++i) kernel_kept_given[i] = given[i];
    for (int i = 0; i < beside.length(); ++i) kernel_kept_beside[i] = beside[i];
}
