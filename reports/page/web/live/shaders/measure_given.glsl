// What every measuring pass is given, behind a codec's six functions: one normal and one view a texel, a block of SIDE by
// SIDE texels again and again. The macros are those that measure.js defines for a codec.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;

uniform sampler2D normals, views;

ivec2 place() { return ivec2(gl_FragCoord.xy) & (SIDE - 1); }

#if HAS_CODEC
CODE encoded() {
    vec3 n = texelFetch(normals, place(), 0).xyz, view = texelFetch(views, place(), 0).xyz;
    return ENCODE(ENCODE_TAKES);
}
#endif
