// Numbers of a texture written to a render target as they are.
precision highp float;
precision highp sampler2D;
uniform sampler2D given;
out vec4 texel;

void main() { texel = texelFetch(given, ivec2(gl_FragCoord.xy), 0); }
