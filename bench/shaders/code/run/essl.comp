#version 310 es
// The six functions of a file, on three rows of four numbers for each normal: normal, view and a texel.
precision highp float;
precision highp int;
precision highp sampler2D;
#include CODE
#include "six.glsl"
