// A surface to what a shader writes to the targets of a layout, or back, number by number: the functions that
// gbuffer.glsl.j2 makes of the layout. Whole numbers go in and come out by their bits.
#include "vec.glsl"
#include "storage.glsl"
#include ENCODING
#include "turned.glsl"
#include DEPTH_ENCODING
#include CURVES
FUNCTIONS

MADE kernel_operation(GIVEN given, BESIDE beside) {
    KERNEL_FROM from;
    MADE made;
    KERNEL_LOADS
    KERNEL_TO to = KERNEL_FUNCTION(from, vec3(0.0), KERNEL_NEAR, KERNEL_FAR);
    KERNEL_STORES
    return made;
}
