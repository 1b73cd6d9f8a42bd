#version 430
// Writes a texture to the target as it is: what is left is the target's own conversion.

uniform sampler2D source;
out vec4 texel;

void main() { texel = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }
