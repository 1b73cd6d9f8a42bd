// Unity HDRP and Timberdoodle: the octahedral map for 12:12 bits, in [-1, 1], with Unity's types and names.
#define FOLD(v) ((1.0 - abs((v).yx)) * FastSignOf(v))

static const real ONE = 1.0;

real2 FastSignOf(real2 v) { return v >= 0.0 ? ONE : -ONE; }

real2 PackNormalOctQuadEncode(real3 n) {
    n *= rcp(max(dot(abs(n), 1.0), 1e-6));
    return n.z >= 0.0 ? n.xy : FOLD(n.xy);
}

real3 UnpackNormalOctQuadEncode(real2 f) {
    real3 n = real3(f, 1.0 - abs(f.x) - abs(f.y));
    n.xy -= FastSignOf(n.xy) * saturate(-n.z);
    return normalize(n);
}
