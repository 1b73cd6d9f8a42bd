#version 430
// One operation between interpolation and export, for a compiler to be asked what it costs. What goes in is written
// again, so that no input is dropped for want of a use.
#include OPERATION

layout(location = 0) in GIVEN given;
layout(location = 1) in BESIDE beside;
layout(location = 0) out MADE made;
layout(location = 1) out GIVEN kept_given;
layout(location = 2) out BESIDE kept_beside;

void main() {
    made = operation(given, beside);
    kept_given = given;
    kept_beside = beside;
}
