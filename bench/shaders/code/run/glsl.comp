#version 430
// The six functions of a file, on three rows of four numbers for each normal: normal, view and a texel.
#include CODE
#include "six.glsl"
