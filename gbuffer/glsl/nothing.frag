#version 430
// Depth and stencil only.

void main() {}
