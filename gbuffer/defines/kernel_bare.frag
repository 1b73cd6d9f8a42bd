#version 430
// One operation between interpolation and export, and nothing else. Where up to five operations share an instruction,
// writing again what goes in, as kernel.frag does, would fill slots that the operation leaves free, and take some.
#include OPERATION

layout(location = 0) in GIVEN kernel_given;
layout(location = 1) in BESIDE kernel_beside;
layout(location = 0) out MADE kernel_made;

void main() { kernel_made = kernel_operation(kernel_given, kernel_beside); }
