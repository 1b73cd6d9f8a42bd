// Stored codes decoded: to the bits of a normal, or to a colour where only the time counts.
#ifdef PACKED
uniform usampler2D codes;
#else
uniform sampler2D codes;
#endif
#ifdef TIMED
out vec4 colour;
#else
out uvec4 bits;
#endif

// A code's last number is not stored where it is a sign: it is kept in the sign of a depth.
float kept_sign() {
#if defined TIMED
    return texelFetch(normals, place(), 0).z < 0.0 ? -1.0 : 1.0;
#elif defined HAS_SIGN
    return encoded()[SIZE - 1];
#else
    return 1.0;
#endif
}

void main() {
    float sign = kept_sign();
    vec3 view = texelFetch(views, place(), 0).xyz;
#ifdef PACKED
    CODE e = UNPACK(texelFetch(codes, place(), 0), sign);
#else
    CODE e = FROM_TARGET(texelFetch(codes, place(), 0), sign);
#endif
    vec3 n = DECODE(e, view);
#ifdef TIMED
    colour = vec4(n * 0.5 + 0.5, 1.0);
#else
    bits = uvec4(floatBitsToUint(n), 0u);
#endif
}
