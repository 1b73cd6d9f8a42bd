// What every measuring pass is given: one normal and one view a texel, a block of BLOCK by BLOCK texels again and again.
precision highp float;
precision highp sampler2D;
precision highp usampler2D;

uniform sampler2D normals, views;

ivec2 place() { return ivec2(gl_FragCoord.xy) & (BLOCK - 1); }

#ifdef CODE
CODE encoded() { return ENCODE(texelFetch(normals, place(), 0).xyz, texelFetch(views, place(), 0).xyz); }
#endif
