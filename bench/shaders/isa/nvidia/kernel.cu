// One operation between loads and stores, as kernel.comp has it: what goes in is stored again, so that no load is dropped
// for want of a use, and every load has arrived where the operation begins.
extern "C" __global__ void __launch_bounds__(GROUP) kernel(float (*planes)[GROUP]) {
    const uint lane = threadIdx.x;
    GIVEN given;
    BESIDE beside;
    uint bits = 0u;
    for (int i = 0; i < given.length(); ++i) bits ^= floatBitsToUint(given[i] = planes[i][lane]);
    for (int i = 0; i < beside.length(); ++i) bits ^= floatBitsToUint(beside[i] = planes[BESIDE_PLANE + i][lane]);
    if (bits == 0u) return;
    const MADE made = kernel_operation(given, beside);
    for (int i = 0; i < beside.length(); ++i) planes[i][lane] = beside[i];
    for (int i = 0; i < given.length(); ++i) planes[4 + i][lane] = given[i];
    for (int i = 0; i < made.length(); ++i) planes[BESIDE_PLANE + 4 + i][lane] = made[i];
}
