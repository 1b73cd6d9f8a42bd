#version 450
// One operation between loads and stores, for a compiler to be asked what it costs. What goes in is stored again, so that
// no load is dropped for want of a use; numbers lie in planes, so that no store wants them in neighbouring registers.
// Planes are used twice, each of a store's after its loads: farther ones are out of reach of GCN's offsets of 4095
// bytes, and would take instructions to reach that the operation could be blamed for. Of more numbers than fit there, the
// empty kernel takes as many.
#include OPERATION

layout(local_size_x = GROUP) in;
layout(std430, binding = PLANES) buffer KernelPlanes { float kernel_planes[][GROUP]; };

void main() {
    uint lane = gl_LocalInvocationID.x;
    GIVEN given;
    BESIDE beside;
    uint bits = 0u;
    for (int i = 0; i < given.length(); ++i) bits ^= floatBitsToUint(given[i] = kernel_planes[i][lane]);
    for (int i = 0; i < beside.length(); ++i) bits ^= floatBitsToUint(beside[i] = kernel_planes[BESIDE_PLANE + i][lane]);
    // Every load has arrived here: waiting for them one by one, as suits what lies between, is no cost of the operation.
    if (bits == 0u) return;
    MADE made = kernel_operation(given, beside);
    for (int i = 0; i < beside.length(); ++i) kernel_planes[i][lane] = beside[i];
    for (int i = 0; i < given.length(); ++i) kernel_planes[4 + i][lane] = given[i];
    for (int i = 0; i < made.length(); ++i) kernel_planes[BESIDE_PLANE + 4 + i][lane] = made[i];
}
