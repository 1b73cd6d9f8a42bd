// Stored codes decoded: to the bits of a normal, or to a colour where only the time counts.
#if PACKS
uniform usampler2D codes;
#else
uniform sampler2D codes;
#endif
#if TIMED
layout(location = 0) out vec4 colour;
#else
layout(location = 0) out uvec4 bits;
#endif

// The last number of a code that has a sign is not stored: it is kept in the sign of a depth.
float kept_sign() {
#if TIMED
    return texelFetch(normals, place(), 0).z < 0.0 ? -1.0 : 1.0;
#elif HAS_SIGN
    return encoded().SIGN;
#else
    return 1.0;
#endif
}

void main() {
    vec3 view = texelFetch(views, place(), 0).xyz;
    float sign = kept_sign();
#if PACKS
    CODE e = UNPACK(texelFetch(codes, place(), 0).PACKED STORED_SIGN);
#else
    CODE e = FROM_TARGET(texelFetch(codes, place(), 0) STORED_SIGN);
#endif
    vec3 n = DECODE(DECODE_TAKES);
#if TIMED
    colour = vec4(n * 0.5 + 0.5, 1.0);
#else
    bits = uvec4(floatBitsToUint(n), 0u);
#endif
}
