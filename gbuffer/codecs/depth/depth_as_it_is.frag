#version 430
// Writes a texture's third channel to the target's first as it is, or to the depth buffer (HOME 2): what is left is the
// format's own conversion.

uniform sampler2D points;
#if HOME == 2
#define number gl_FragDepth
#else
layout(location = 0) out float number;
#endif

void main() { number = texelFetch(points, ivec2(gl_FragCoord.xy), 0).z; }
