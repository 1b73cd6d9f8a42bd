#version 430
// One operation between loads and stores, for a compiler to be asked what it costs. What goes in is stored again, so that
// no load is dropped for want of a use; numbers lie in planes, so that no store wants them in neighbouring registers.
#include OPERATION

layout(local_size_x = GROUP) in;
layout(std430, binding = PLANES) buffer Planes { float planes[][GROUP]; };

void main() {
    uint lane = gl_LocalInvocationID.x;
    GIVEN given;
    BESIDE beside;
    uint bits = 0u;
    for (int i = 0; i < given.length(); ++i) bits ^= floatBitsToUint(given[i] = planes[i][lane]);
    for (int i = 0; i < beside.length(); ++i) bits ^= floatBitsToUint(beside[i] = planes[4 + i][lane]);
    // Every load has arrived here: waiting for them one by one, as suits what lies between, is no cost of the operation.
    if (bits == 0u) return;
    MADE made = operation(given, beside);
    for (int i = 0; i < given.length(); ++i) planes[8 + i][lane] = given[i];
    for (int i = 0; i < beside.length(); ++i) planes[12 + i][lane] = beside[i];
    for (int i = 0; i < made.length(); ++i) planes[16 + i][lane] = made[i];
}
